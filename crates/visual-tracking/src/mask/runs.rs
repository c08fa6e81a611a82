//! Bits of a word and runs of bits in a row of words.

use std::ops::Range;

/// The bits of a word that are on, from the lowest.
pub(crate) fn ones(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (word != 0).then_some(word.trailing_zeros() as usize);
        word &= word.wrapping_sub(1);
        bit
    })
}

/// The columns that are on without a gap, from the left.
pub(super) fn runs(row: &[u64]) -> impl Iterator<Item = Range<usize>> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = next_one(row, from, 0)?;
        from = next_one(row, start, u64::MAX).unwrap_or(64 * row.len());
        Some(start..from)
    })
}

/// Switches on the columns of a run that the row has.
pub(super) fn fill(row: &mut [u64], run: Range<usize>) {
    for (i, word) in row.iter_mut().enumerate().take(run.end.div_ceil(64)).skip(run.start / 64) {
        *word |= within(&run, i);
    }
}

/// Number of columns of a run that are on.
pub(super) fn count(row: &[u64], run: Range<usize>) -> usize {
    let words = row.iter().enumerate().take(run.end.div_ceil(64)).skip(run.start / 64);
    words.map(|(i, word)| (word & within(&run, i)).count_ones() as usize).sum()
}

/// The columns of word `i` that are in a run that reaches into it.
fn within(run: &Range<usize>, i: usize) -> u64 {
    let from = u64::MAX << run.start.saturating_sub(64 * i);
    let rest = run.end - 64 * i;
    if rest >= 64 { from } else { from & !(u64::MAX << rest) }
}

/// The first bit at or after `from` that differs from those of `off`.
fn next_one(row: &[u64], from: usize, off: u64) -> Option<usize> {
    let mut i = from / 64;
    let mut word = (row.get(i)? ^ off) & (u64::MAX << (from % 64));
    while word == 0 {
        i += 1;
        word = row.get(i)? ^ off;
    }
    Some(64 * i + word.trailing_zeros() as usize)
}
