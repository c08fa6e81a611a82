//! A row of pixels as bits, the first column lowest.

pub(super) const BITS: usize = u64::BITS as usize;

/// Sets the columns `start..end`; there must be one.
pub(super) fn set(words: &mut [u64], start: usize, end: usize) {
    let (first, last) = (start / BITS, (end - 1) / BITS);
    for (index, word) in words.iter_mut().enumerate().take(last + 1).skip(first) {
        let from = if index == first { u64::MAX << (start % BITS) } else { u64::MAX };
        let to = if index == last { u64::MAX >> (BITS - 1 - (end - 1) % BITS) } else { u64::MAX };
        *word |= from & to;
    }
}

/// Runs of set columns within `start..end`.
pub(super) fn runs_of_ones(words: &[u64], start: usize, end: usize, run: impl FnMut(usize, usize)) {
    runs(words, start, end, 0, run);
}

/// Runs of clear columns within `start..end`.
pub(super) fn runs_of_zeros(words: &[u64], start: usize, end: usize, run: impl FnMut(usize, usize)) {
    runs(words, start, end, u64::MAX, run);
}

/// Runs of ones of the words, each xor `flip`.
fn runs(words: &[u64], start: usize, end: usize, flip: u64, mut run: impl FnMut(usize, usize)) {
    let mut at = next_one(words, start, end, flip);
    while at < end {
        let stop = next_one(words, at, end, !flip);
        run(at, stop);
        at = next_one(words, stop, end, flip);
    }
}

/// The first one from column `at` on, or `end`.
fn next_one(words: &[u64], at: usize, end: usize, flip: u64) -> usize {
    if at >= end {
        return end;
    }
    let mut index = at / BITS;
    let mut word = (words[index] ^ flip) & (u64::MAX << (at % BITS));
    while word == 0 {
        index += 1;
        if index * BITS >= end {
            return end;
        }
        word = words[index] ^ flip;
    }
    (index * BITS + word.trailing_zeros() as usize).min(end)
}
