use std::cmp::Ordering;
use std::ops::Range;

use nalgebra::Vector2;

use super::baseline::Baseline;

const BLOCK: usize = 128;

/// Finds farthest points by testing every point.
#[derive(Clone, Debug, Default)]
pub(super) struct Scanner {
    /// Room to note the blocks that may hold the farthest point.
    blocks: Vec<usize>,
    /// Number of comparisons close enough to need exact arithmetic.
    pub(super) n_exact_comparisons: usize,
}

impl Scanner {
    /// The first of the points farthest from the line, exactly, or `None` if no point is computed to be farther than `limit`.
    ///
    /// Only the maximum of a block is computed for all points, which takes a few instructions each; the blocks that may hold the
    /// farthest point are gone through again.
    pub(super) fn farthest(
        &mut self,
        points: &[Vector2<f64>],
        range: Range<usize>,
        line: &Baseline,
        limit: f64,
    ) -> Option<usize> {
        let most = self.note_blocks(points, &range, line);
        if most / line.length() <= limit {
            return None;
        }
        let mut best = None;
        for &begin in &self.blocks {
            for k in begin..range.end.min(begin + BLOCK) {
                if line.cross(&points[k]).abs() >= most - line.margin() {
                    self.n_exact_comparisons += usize::from(best.is_some());
                    best = Some(farther(points, line, best, k));
                }
            }
        }
        best
    }

    /// The largest computed value, and in `blocks` the positions of values that may be equally large.
    fn note_blocks(&mut self, points: &[Vector2<f64>], range: &Range<usize>, line: &Baseline) -> f64 {
        let mut most = 0.0;
        self.blocks.clear();
        for begin in range.clone().step_by(BLOCK) {
            let at_block = largest(&points[begin..range.end.min(begin + BLOCK)], line);
            if at_block > most + line.margin() {
                self.blocks.clear();
            }
            if at_block >= most - line.margin() {
                self.blocks.push(begin);
            }
            most = greater(at_block, most);
        }
        most
    }
}

/// The farther of two points; the one that was there first if they are equally far.
pub(super) fn farther(points: &[Vector2<f64>], line: &Baseline, best: Option<usize>, k: usize) -> usize {
    match best {
        Some(best) if line.compare(&points[k], &points[best]) != Ordering::Greater => best,
        _ => k,
    }
}

/// Four running maxima, so that comparisons do not wait for each other.
#[inline]
fn largest(points: &[Vector2<f64>], line: &Baseline) -> f64 {
    let mut lanes = [0.0_f64; 4];
    let whole = points.chunks_exact(4);
    let rest = whole.remainder();
    for four in whole {
        for (lane, point) in lanes.iter_mut().zip(four) {
            *lane = greater(line.cross(point).abs(), *lane);
        }
    }
    let rest = rest.iter().fold(0.0, |most, point| greater(line.cross(point).abs(), most));
    lanes.into_iter().fold(rest, greater)
}

/// As `f64::max` of numbers that are not NaN, in one instruction.
#[inline]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
