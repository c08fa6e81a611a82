//! Farthest-point queries on the hulls.

use std::cmp::Ordering;
use std::ops::Range;

use nalgebra::Vector2;

use super::baseline::Baseline;
use super::hull_tree::{HullTree, LEAF, Level};
use super::scan::{Scanner, farther};

/// Every distance is beyond it.
const NO_LIMIT: f64 = -1.0;

/// The level of a block, and its place there.
#[derive(Clone, Copy)]
struct Block {
    level: usize,
    place: usize,
}

impl HullTree {
    /// The same answer as [`Scanner::farthest`], in $`O(\log^2 n)`$.
    pub(super) fn farthest(
        &self,
        points: &[Vector2<f64>],
        range: Range<usize>,
        line: &Baseline,
        scanner: &mut Scanner,
    ) -> Option<usize> {
        let mut scan = |range| scanner.farthest(points, range, line, NO_LIMIT);
        let (first, last) = (range.start.div_ceil(LEAF), range.end / LEAF);
        if first >= last {
            return scan(range);
        }
        let before = scan(range.start..first * LEAF);
        let after = scan(last * LEAF..range.end);
        let value = |k: Option<usize>| k.map_or(0.0, |k| line.cross(&points[k]).abs());
        let mut least = value(before).max(value(after));

        // From left to right, so that the first of equally far points wins.
        let (mut best, mut tied) = (before, None);
        for block in Cover::new(first, last) {
            let level = &self.levels[block.level];
            let [low, high] = &level.boxes[block.place];
            if line.bound(low, high) < least - line.margin() {
                continue;
            }
            let (k, has_equals) = level.farthest(points, block.place, line);
            if best.is_none_or(|best| line.compare(&points[k], &points[best]) == Ordering::Greater) {
                (best, tied) = (Some(k), has_equals.then_some(block));
                least = least.max(value(best));
            }
        }
        if let Some(k) = after
            && farther(points, line, best, k) == k
        {
            return after;
        }
        match (tied, best) {
            (Some(block), Some(best)) => Some(self.first_as_far(points, block, line, best)),
            _ => best,
        }
    }

    /// The first point of a block that is as far as `best`, which the block contains: descends the levels, left where possible.
    fn first_as_far(&self, points: &[Vector2<f64>], block: Block, line: &Baseline, best: usize) -> usize {
        let as_far = |k: usize| line.compare(&points[k], &points[best]) == Ordering::Equal;
        let mut place = block.place;
        for level in self.levels[..block.level].iter().rev() {
            let (k, _) = level.farthest(points, 2 * place, line);
            place = if as_far(k) { 2 * place } else { 2 * place + 1 };
        }
        (place * LEAF..(place + 1) * LEAF).find(|k| as_far(*k)).unwrap_or(best)
    }
}

impl Level {
    /// One of the farthest points of a block, and whether others may be equally far.
    fn farthest(&self, points: &[Vector2<f64>], place: usize, line: &Baseline) -> (usize, bool) {
        let (above, above_tied) = extreme(points, self.upper.of(place), line, Ordering::Greater);
        let (below, below_tied) = extreme(points, self.lower.of(place), line, Ordering::Less);
        match line.compare(&points[above], &points[below]) {
            Ordering::Greater => (above, above_tied),
            Ordering::Less => (below, below_tied),
            Ordering::Equal => (above.min(below), above_tied || below_tied || above != below),
        }
    }
}

/// Index at which half a hull stops leading away from the line, and whether its next edge is parallel to it.
fn extreme(points: &[Vector2<f64>], half: &[u32], line: &Baseline, away: Ordering) -> (usize, bool) {
    let away = if line.is_rightward() { away } else { away.reverse() };
    let turn = |t: usize| line.turn(&points[half[t] as usize], &points[half[t + 1] as usize]);
    let (mut low, mut high) = (0, half.len() - 1);
    while low < high {
        let middle = usize::midpoint(low, high);
        if turn(middle) == away { low = middle + 1 } else { high = middle }
    }
    (half[low] as usize, low + 1 < half.len() && turn(low) == Ordering::Equal)
}

/// The largest blocks that cover a range of blocks of the lowest level, from left to right.
struct Cover {
    next: usize,
    end: usize,
}

impl Cover {
    fn new(first: usize, last: usize) -> Self {
        Self { next: first, end: last }
    }
}

impl Iterator for Cover {
    type Item = Block;

    fn next(&mut self) -> Option<Block> {
        let room = self.end.checked_sub(self.next).filter(|room| *room > 0)?;
        let level = room.ilog2().min(self.next.trailing_zeros()) as usize;
        let place = self.next >> level;
        self.next += 1 << level;
        Some(Block { level, place })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_a_range_without_gap_or_overlap() {
        for first in 0..70 {
            for last in first..70 {
                let mut at = first;
                for block in Cover::new(first, last) {
                    assert_eq!(block.place << block.level, at);
                    at += 1 << block.level;
                }
                assert_eq!(at, last);
            }
        }
    }
}
