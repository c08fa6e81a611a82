use std::cmp::Ordering;

use nalgebra::Vector2;

use super::baseline::turn;

/// Points in a block of the lowest level.
pub(super) const LEAF: usize = 64;

/// Convex hulls of the blocks of 64, 128, 256, … points of a chain, each computed from those of its halves.
///
/// A block's hull holds the farthest point from any line, on either side, and finds it in $`O(\log n)`$. Blocks are index ranges, so the chain
/// may cross itself as it likes.
#[derive(Default)]
pub(super) struct HullTree {
    pub(super) levels: Vec<Level>,
}

/// The hulls of all whole blocks of one size.
#[derive(Default)]
pub(super) struct Level {
    pub(super) upper: Sides,
    pub(super) lower: Sides,
    /// The box around each block.
    pub(super) boxes: Vec<[Vector2<f64>; 2]>,
}

/// One half of every hull, from its leftmost to its rightmost point, strictly convex.
#[derive(Default)]
pub(super) struct Sides {
    vertices: Vec<u32>,
    /// End of each block's vertices.
    ends: Vec<usize>,
}

impl HullTree {
    /// In $`O(n \log n)`$ time; the memory is that of the hulls, at most 4 bytes a point and level and side.
    pub(super) fn new(points: &[Vector2<f64>]) -> Self {
        let mut levels = Vec::new();
        let mut size = LEAF;
        while size <= points.len() {
            let level = match levels.last() {
                None => Level::of_points(points),
                Some(halves) => Level::of_halves(halves, points),
            };
            levels.push(level);
            size *= 2;
        }
        Self { levels }
    }
}

impl Level {
    fn of_points(points: &[Vector2<f64>]) -> Self {
        let mut level = Self::default();
        let mut order: Vec<u32> = Vec::with_capacity(LEAF);
        for (block, leaf) in points.chunks_exact(LEAF).enumerate() {
            let start = (block * LEAF) as u32;
            order.clear();
            order.extend(start..start + LEAF as u32);
            order.sort_unstable_by(|&i, &j| left_to_right(points, i, j).then(i.cmp(&j)));
            level.upper.push_hull(points, order.iter().copied(), Ordering::Less);
            level.lower.push_hull(points, order.iter().copied(), Ordering::Greater);
            level.boxes.push(leaf.iter().fold([leaf[0]; 2], |[low, high], p| [low.inf(p), high.sup(p)]));
        }
        level
    }

    fn of_halves(halves: &Self, points: &[Vector2<f64>]) -> Self {
        let mut level = Self::default();
        for (pair, boxes) in halves.boxes.chunks_exact(2).enumerate() {
            for (side, below, way) in [
                (&mut level.upper, &halves.upper, Ordering::Less),
                (&mut level.lower, &halves.lower, Ordering::Greater),
            ] {
                let merged = Merge { points, left: below.of(2 * pair), right: below.of(2 * pair + 1) };
                side.push_hull(points, merged, way);
            }
            level.boxes.push([boxes[0][0].inf(&boxes[1][0]), boxes[0][1].sup(&boxes[1][1])]);
        }
        level
    }
}

impl Sides {
    /// The vertices of a block's half hull.
    pub(super) fn of(&self, block: usize) -> &[u32] {
        let start = if block == 0 { 0 } else { self.ends[block - 1] };
        &self.vertices[start..self.ends[block]]
    }

    /// Appends the half hull of points sorted from left to right that turn only one `way` [Andrew 1979].
    ///
    /// Of coincident points the first is kept.
    fn push_hull(&mut self, points: &[Vector2<f64>], order: impl Iterator<Item = u32>, way: Ordering) {
        let at = |k: u32| &points[k as usize];
        let start = self.vertices.len();
        for k in order {
            if self.vertices.len() > start && at(self.vertices[self.vertices.len() - 1]) == at(k) {
                continue;
            }
            while let [.., a, b] = self.vertices[start..] {
                if turn(at(a), at(b), at(b), at(k)) == way {
                    break;
                }
                self.vertices.pop();
            }
            self.vertices.push(k);
        }
        self.ends.push(self.vertices.len());
    }
}

/// Two sorted lists as one; the left one first where they agree.
struct Merge<'a> {
    points: &'a [Vector2<f64>],
    left: &'a [u32],
    right: &'a [u32],
}

impl Iterator for Merge<'_> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let from_left = match (self.left.first(), self.right.first()) {
            (Some(&i), Some(&j)) => left_to_right(self.points, i, j) != Ordering::Greater,
            (left, _) => left.is_some(),
        };
        let list = if from_left { &mut self.left } else { &mut self.right };
        let (&next, rest) = list.split_first()?;
        *list = rest;
        Some(next)
    }
}

/// By x, then by y.
fn left_to_right(points: &[Vector2<f64>], i: u32, j: u32) -> Ordering {
    let (p, q) = (&points[i as usize], &points[j as usize]);
    (p.x, p.y).partial_cmp(&(q.x, q.y)).unwrap_or(Ordering::Equal)
}
