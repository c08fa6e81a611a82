use std::cmp::Ordering;
use std::ops::Range;

use nalgebra::Vector2;

use super::baseline::Baseline;

const BLOCK: usize = 128;

/// The first of the points farthest from the line, exactly, by looking at each.
///
/// Only the maximum of a block is computed for all points, which takes a few instructions each; the blocks that may hold the
/// farthest point are gone through again. `blocks` is room to note them.
pub(super) fn farthest(
    points: &[Vector2<f64>],
    range: Range<usize>,
    line: &Baseline,
    blocks: &mut Vec<usize>,
) -> Option<usize> {
    let mut most = 0.0;
    blocks.clear();
    for begin in range.clone().step_by(BLOCK) {
        let at_block = largest(&points[begin..range.end.min(begin + BLOCK)], line);
        if at_block > most + line.margin() {
            blocks.clear();
        }
        if at_block >= most - line.margin() {
            blocks.push(begin);
        }
        if at_block > most {
            most = at_block;
        }
    }
    let mut best = None;
    for &begin in blocks.iter() {
        for k in begin..range.end.min(begin + BLOCK) {
            if line.cross(&points[k]).abs() >= most - line.margin() {
                best = Some(farther(points, line, best, k));
            }
        }
    }
    best
}

/// The farther of two points; the one that was there first if they are equally far.
pub(super) fn farther(points: &[Vector2<f64>], line: &Baseline, best: Option<usize>, k: usize) -> usize {
    match best {
        Some(best) if line.compare(&points[k], &points[best]) != Ordering::Greater => best,
        _ => k,
    }
}

/// Four running maxima, so that no comparison waits for the one before.
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
