use std::ops::Range;

use super::PixelConnectivity;
use super::runs::{count, fill, runs};
use crate::{PixelMask, PixelRect, TrackingError};

/// The connected parts of a mask, in the order of their first pixels row by row.
///
/// ```
/// use wayfix_visual_tracking::{PixelMask, PixelConnectivity};
/// let mask = PixelMask::from_fn(80, 20, |u, v| (u < 5 && v < 5) || (u > 60 && v > 10))?;
/// let blobs = mask.blobs(PixelConnectivity::Eight);
/// assert_eq!(blobs.iter().map(|blob| blob.area).collect::<Vec<_>>(), [25, 19 * 9]);
/// assert_eq!((blobs.largest(), blobs.nearest([9.0, 9.0])), (Some(1), Some(0)));
/// assert_eq!(blobs.mask(0).and_then(|mask| mask.centroid()), Some([2.5, 2.5]));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Blobs {
    size: (usize, usize),
    runs: Vec<Run>,
    blobs: Vec<Blob>,
}

/// A connected part of a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blob {
    /// Number of pixels.
    pub area: usize,
    /// The bounding rectangle.
    pub rect: PixelRect,
}

#[derive(Clone, Debug)]
struct Run {
    row: usize,
    columns: Range<usize>,
    blob: usize,
}

impl Blobs {
    /// Number of blobs.
    pub fn len(&self) -> usize {
        self.blobs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.blobs.is_empty()
    }

    /// All of them.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Blob> {
        self.blobs.iter()
    }

    /// The one with the most pixels; the first of several.
    pub fn largest(&self) -> Option<usize> {
        first_max(self.blobs.iter().map(|blob| blob.area))
    }

    /// The one with the pixel nearest to `point`, `[u, v]` in pixels; the largest of several. A point inside a pixel is nearest to it; none is
    /// near a point that is not finite.
    pub fn nearest(&self, point: [f64; 2]) -> Option<usize> {
        if !point.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut distances = vec![f64::INFINITY; self.len()];
        for run in &self.runs {
            let beside = outside(point[0], run.columns.start as f64, run.columns.end as f64);
            let above = outside(point[1], run.row as f64, (run.row + 1) as f64);
            distances[run.blob] = distances[run.blob].min(beside.hypot(above));
        }
        let closer = |a: &usize, b: &usize| {
            let by_area = || self.blobs[*b].area.cmp(&self.blobs[*a].area);
            distances[*a].total_cmp(&distances[*b]).then_with(by_area)
        };
        (0..self.len()).min_by(closer)
    }

    /// The blob that shares the most pixels with a mask; `None` if none shares any.
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if the mask differs in size.
    pub fn most_overlapping(&self, mask: &PixelMask) -> Result<Option<usize>, TrackingError> {
        mask.check_size(self.size)?;
        let mut shared = vec![0; self.len()];
        for run in &self.runs {
            shared[run.blob] += count(mask.row(run.row), run.columns.clone());
        }
        Ok(first_max(shared.iter().copied()).filter(|&blob| shared[blob] > 0))
    }

    /// The pixels of one blob; `None` if it does not exist.
    pub fn mask(&self, blob: usize) -> Option<PixelMask> {
        (blob < self.len()).then(|| self.union(|i| i == blob))
    }

    /// The pixels of all blobs for which `keep` is true.
    pub fn filtered(&self, mut keep: impl FnMut(&Blob) -> bool) -> PixelMask {
        let kept: Vec<bool> = self.blobs.iter().map(&mut keep).collect();
        self.union(|blob| kept[blob])
    }

    fn union(&self, keep: impl Fn(usize) -> bool) -> PixelMask {
        let mut mask = PixelMask::empty(self.size.0, self.size.1)
            .expect("invariant: the size of the mask they come from");
        for run in self.runs.iter().filter(|run| keep(run.blob)) {
            fill(mask.row_mut(run.row), run.columns.clone());
        }
        mask
    }
}

impl PixelMask {
    /// The connected parts, joined run by run.
    pub fn blobs(&self, connectivity: PixelConnectivity) -> Blobs {
        let reach = usize::from(connectivity == PixelConnectivity::Eight);
        let ends_before = |a: &Range<usize>, b: &Range<usize>| a.end + reach <= b.start;
        let (mut all, mut parents) = (Vec::<Run>::new(), Vec::new());
        let mut above = 0..0;
        for (row, words) in self.rows().enumerate() {
            let first = all.len();
            for columns in runs(words) {
                let blob = parents.len();
                parents.push(blob);
                // Runs come from left to right: one above that ends before this one ends before all later ones.
                while above.start < above.end && ends_before(&all[above.start].columns, &columns) {
                    above.start += 1;
                }
                for touching in above.clone().take_while(|&i| !ends_before(&columns, &all[i].columns)) {
                    join(&mut parents, touching, blob);
                }
                all.push(Run { row, columns, blob });
            }
            above = first..all.len();
        }
        gather((self.width(), self.height()), all, &mut parents)
    }

    /// Number of enclosed parts of the background.
    pub fn n_holes(&self, connectivity: PixelConnectivity) -> usize {
        self.not().blobs(connectivity.dual()).iter().filter(|blob| self.encloses(&blob.rect)).count()
    }

    /// The mask without its holes.
    ///
    /// ```
    /// use wayfix_visual_tracking::{PixelMask, PixelConnectivity};
    /// let ring = PixelMask::from_fn(9, 9, |u, v| u.abs_diff(4).max(v.abs_diff(4)) == 3)?;
    /// assert_eq!((ring.area(), ring.n_holes(PixelConnectivity::Eight)), (24, 1));
    /// assert_eq!(ring.without_holes(PixelConnectivity::Eight).area(), 49);
    /// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
    /// ```
    pub fn without_holes(&self, connectivity: PixelConnectivity) -> Self {
        let outside = self.not().blobs(connectivity.dual()).filtered(|blob| !self.encloses(&blob.rect));
        outside.not()
    }

    /// Whether a rectangle touches no edge.
    fn encloses(&self, rect: &PixelRect) -> bool {
        let inside = |start: usize, n: usize, len: usize| start > 0 && start + n < len;
        inside(rect.left, rect.width, self.width()) && inside(rect.top, rect.height, self.height())
    }
}

/// Numbers the roots in the order in which they appear, and adds up their runs.
fn gather(size: (usize, usize), mut runs: Vec<Run>, parents: &mut [usize]) -> Blobs {
    let mut blobs: Vec<Blob> = Vec::new();
    // A root precedes all members of its tree.
    let mut numbers = vec![0; runs.len()];
    for (i, run) in runs.iter_mut().enumerate() {
        let root = root(parents, i);
        let piece = PixelRect { left: run.columns.start, top: run.row, width: run.columns.len(), height: 1 };
        if root == i {
            numbers[i] = blobs.len();
            blobs.push(Blob { area: piece.width, rect: piece });
        } else {
            let blob = &mut blobs[numbers[root]];
            blob.area += piece.width;
            blob.rect = blob.rect.union(&piece);
        }
        run.blob = numbers[root];
    }
    Blobs { size, runs, blobs }
}

/// Joins two trees; the earlier root stays the root.
fn join(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

/// The root of a tree, with path shortening.
fn root(parents: &mut [usize], mut i: usize) -> usize {
    while parents[i] != i {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    i
}

/// Distance of `x` from `start .. end`.
fn outside(x: f64, start: f64, end: f64) -> f64 {
    (start - x).max(x - end).max(0.0)
}

fn first_max(values: impl Iterator<Item = usize>) -> Option<usize> {
    values.enumerate().max_by_key(|&(i, value)| (value, std::cmp::Reverse(i))).map(|(i, _)| i)
}
