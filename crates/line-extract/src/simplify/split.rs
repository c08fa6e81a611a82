//! The order in which a chain is taken apart, common to all variants.

use super::chain::Chain;

/// Splits ranges until `find` returns no more point, and writes the kept indices in order [Douglas & Peucker 1973].
///
/// `find(i, j)` is the split point between `i` and `j`, or `None`. Pending ranges share their ends, so a list of ends on the heap suffices, at most
/// as long as the chain.
pub(super) fn split_all(
    n: usize,
    ends: &mut Vec<usize>,
    kept: &mut Vec<usize>,
    mut find: impl FnMut(usize, usize) -> Option<usize>,
) {
    kept.clear();
    ends.clear();
    if n == 0 {
        return;
    }
    kept.push(0);
    if n > 1 {
        ends.push(n - 1);
    }
    let mut start = 0;
    while let Some(&end) = ends.last() {
        if let Some(split) = if end - start > 1 { find(start, end) } else { None } {
            ends.push(split);
        } else {
            kept.push(end);
            start = end;
            ends.pop();
        }
    }
}

/// Split point of a chain with coincident ends: the farthest from that point, if farther than the tolerance.
///
/// A split point differs from both ends, so only the whole chain can be such a range, once.
pub(super) fn split_loop(chain: &Chain, start: usize, end: usize) -> Option<usize> {
    let center = &chain.points[start];
    let squared = |k: usize| (chain.points[k] - center).norm_squared();
    let farthest = first_max(start + 1..end, squared)?;
    (squared(farthest).sqrt() > chain.epsilon).then_some(farthest)
}

/// The first place of the largest value.
pub(crate) fn first_max(range: std::ops::Range<usize>, value: impl Fn(usize) -> f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for k in range {
        let at_k = value(k);
        if best.is_none_or(|(_, most)| at_k > most) {
            best = Some((k, at_k));
        }
    }
    best.map(|(k, _)| k)
}
