//! A row of pixels as bits, the first column lowest.

pub(super) const BITS: usize = u64::BITS as usize;

/// Sets the columns `start..end`.
pub(super) fn set(words: &mut [u64], start: usize, end: usize) {
    masks(start, end).for_each(|(index, mask)| words[index] |= mask);
}

/// Sets the columns `start..end` and reports the runs of those that were not set.
pub(super) fn claim(words: &mut [u64], start: usize, end: usize, run: impl FnMut(usize, usize)) {
    let free = masks(start, end).map(|(index, mask)| {
        let free = mask & !words[index];
        words[index] |= mask;
        (index, free)
    });
    runs(free, run);
}

/// Tells the runs of set columns within `start..end`.
pub(super) fn runs_of_ones(words: &[u64], start: usize, end: usize, run: impl FnMut(usize, usize)) {
    runs(masks(start, end).map(|(index, mask)| (index, mask & words[index])), run);
}

/// The words that hold the columns `start..end`, which must not be empty, with ones there.
fn masks(start: usize, end: usize) -> impl Iterator<Item = (usize, u64)> {
    let (first, last) = (start / BITS, (end - 1) / BITS);
    (first..last + 1).map(move |index| {
        let from = if index == first { u64::MAX << (start % BITS) } else { u64::MAX };
        let to = if index == last { u64::MAX >> (BITS - 1 - (end - 1) % BITS) } else { u64::MAX };
        (index, from & to)
    })
}

/// Reports the runs of ones, also across words.
fn runs(words: impl Iterator<Item = (usize, u64)>, mut run: impl FnMut(usize, usize)) {
    let (mut start, mut end) = (0, 0);
    for (index, mut word) in words {
        while word != 0 {
            let skipped = word.trailing_zeros();
            let from = index * BITS + skipped as usize;
            if from != end {
                if start < end {
                    run(start, end);
                }
                start = from;
            }
            end = from + (!(word >> skipped)).trailing_zeros() as usize;
            // The carry runs through the lowest run and ends in the zero above it.
            word &= word.wrapping_add(1 << skipped);
        }
    }
    if start < end {
        run(start, end);
    }
}
