use wayfix_color_map::{ColorId, PixelSpan};

use super::NO_COLOR;
use crate::ColorModelError;

/// Connected pixels of one colour.
/// ```
/// use wayfix_color_model::find_blobs;
/// let blob = find_blobs(&[0, 255, 0, 0], 2)?[0]; // three of the four pixels
/// assert_eq!((blob.columns, blob.rows, blob.n_pixels), ((0, 1), (0, 1), 3));
/// assert!((blob.centroid.0 - 2.5 / 3.0).abs() < 1e-12); // of 0.5, 0.5 and 1.5
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorBlob {
    /// Their colour.
    pub color: ColorId,
    /// Number of pixels.
    pub n_pixels: usize,
    /// First and last column.
    pub columns: (usize, usize),
    /// First and last row.
    pub rows: (usize, usize),
    /// Mean of the pixels' centres, (u, v) in pixels: the first pixel's centre is (0.5, 0.5).
    pub centroid: (f64, f64),
}

/// Finds the blobs of a classified image, with 255 for background; pixels connect at an edge or a corner. Blobs are ordered by their first pixel.
///
/// Runs of equal labels are joined with adjacent runs in the row above, and each set of runs is a blob: time in proportion to the pixels.
/// ```
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::find_blobs;
/// let labels = [
///     0, 0, 255, 1, //
///     255, 255, 0, 1, // touches the two above at a corner
/// ];
/// let blobs = find_blobs(&labels, 4)?;
/// assert_eq!(blobs.len(), 2);
/// assert_eq!((blobs[0].n_pixels, blobs[0].columns, blobs[0].rows), (3, (0, 2), (0, 1)));
/// assert_eq!((blobs[1].color, blobs[1].centroid), (ColorId(1), (3.5, 1.0)));
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
///
/// # Errors
/// Returns an error if the labels do not fill rows of `width` pixels, or there are none.
pub fn find_blobs(labels: &[u8], width: usize) -> Result<Vec<ColorBlob>, ColorModelError> {
    if labels.is_empty() || width == 0 || !labels.len().is_multiple_of(width) {
        let height = labels.len().checked_div(width).unwrap_or(0);
        let (expected, got) = (width.saturating_mul(height.max(1)), labels.len());
        return Err(ColorModelError::ImageSize { width, height, expected, got });
    }
    let mut runs = Runs::default();
    for (row, labels) in labels.chunks_exact(width).enumerate() {
        let mut start = 0;
        for same in labels.chunk_by(|a, b| a == b) {
            let end = start + same.len();
            if same[0] != NO_COLOR {
                runs.add(Run { label: same[0], row, start, end });
            }
            start = end;
        }
    }
    Ok(runs.blobs())
}

/// Finds the blobs of an image given as spans, in any order, that do not overlap.
pub(crate) fn blobs_of_spans(spans: &mut [PixelSpan]) -> Vec<ColorBlob> {
    spans.sort_unstable_by_key(|span| (span.row, span.start));
    let mut runs = Runs::default();
    for same in spans.chunk_by(|a, b| (a.row, a.end, a.color) == (b.row, b.start, b.color)) {
        let (first, last) = (same[0], same[same.len() - 1]);
        let [row, start, end] = [first.row, first.start, last.end].map(usize::from);
        runs.add(Run { label: first.color.0, row, start, end });
    }
    runs.blobs()
}

/// A maximal run of pixels of a row with equal labels.
struct Run {
    label: u8,
    row: usize,
    start: usize,
    end: usize,
}

/// All runs so far, as a forest; each root is the first run of its blob.
#[derive(Default)]
struct Runs {
    runs: Vec<Run>,
    parent: Vec<usize>,
    row: usize,
    /// First run of this row, and of the row above.
    this_row: usize,
    last_row: usize,
    /// The first run of the row above that the next one may touch.
    above: usize,
}

impl Runs {
    /// Adds the next run, row by row and from left to right.
    fn add(&mut self, run: Run) {
        let at = self.runs.len();
        if run.row != self.row {
            self.last_row = if run.row == self.row + 1 { self.this_row } else { at };
            (self.row, self.this_row, self.above) = (run.row, at, self.last_row);
        }
        self.runs.push(run);
        self.parent.push(at);
        self.join_above(at);
    }

    /// Joins run `at` with adjacent runs in the row above.
    fn join_above(&mut self, at: usize) {
        let (start, end, label) = (self.runs[at].start, self.runs[at].end, self.runs[at].label);
        let mut above = self.above;
        while above < self.this_row && self.runs[above].start <= end {
            if self.runs[above].end >= start && self.runs[above].label == label {
                self.join(above, at);
            }
            if self.runs[above].end > end {
                break; // it reaches beyond this run
            }
            above += 1;
        }
        // The last one may end where the next run begins, and touch that at a corner.
        self.above = above.saturating_sub(1).max(self.last_row);
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }

    fn root(&mut self, mut at: usize) -> usize {
        while self.parent[at] != at {
            self.parent[at] = self.parent[self.parent[at]];
            at = self.parent[at];
        }
        at
    }

    fn blobs(mut self) -> Vec<ColorBlob> {
        let mut blobs: Vec<ColorBlob> = Vec::new();
        let mut blob_of = vec![0; self.runs.len()];
        for at in 0..self.runs.len() {
            let root = self.root(at);
            let run = &self.runs[at];
            let blob = ColorBlob {
                color: ColorId(run.label),
                n_pixels: run.end - run.start,
                columns: (run.start, run.end - 1),
                rows: (run.row, run.row),
                centroid: (0.5 * (run.start + run.end) as f64, run.row as f64 + 0.5),
            };
            if root == at {
                blob_of[at] = blobs.len();
                blobs.push(blob);
            } else {
                // Roots come first.
                blobs[blob_of[root]].absorb(&blob);
            }
        }
        blobs
    }
}

impl ColorBlob {
    fn absorb(&mut self, other: &Self) {
        let n_pixels = self.n_pixels + other.n_pixels;
        let share = other.n_pixels as f64 / n_pixels as f64;
        self.centroid.0 += (other.centroid.0 - self.centroid.0) * share;
        self.centroid.1 += (other.centroid.1 - self.centroid.1) * share;
        self.columns = (self.columns.0.min(other.columns.0), self.columns.1.max(other.columns.1));
        self.rows = (self.rows.0.min(other.rows.0), self.rows.1.max(other.rows.1));
        self.n_pixels = n_pixels;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, seq::SliceRandom};
    use rand_chacha::ChaCha8Rng;

    /// Pixel by pixel: floods from every pixel that has no blob yet.
    fn flooded(labels: &[u8], width: usize) -> Vec<(u8, Vec<usize>)> {
        let height = labels.len() / width;
        let mut done = vec![false; labels.len()];
        let mut blobs = Vec::new();
        for seed in 0..labels.len() {
            if done[seed] || labels[seed] == NO_COLOR {
                continue;
            }
            let (mut pixels, mut open) = (Vec::new(), vec![seed]);
            done[seed] = true;
            while let Some(at) = open.pop() {
                pixels.push(at);
                let (u, v) = (at % width, at / width);
                for y in v.saturating_sub(1)..=(v + 1).min(height - 1) {
                    for x in u.saturating_sub(1)..=(u + 1).min(width - 1) {
                        let next = y * width + x;
                        if !done[next] && labels[next] == labels[seed] {
                            done[next] = true;
                            open.push(next);
                        }
                    }
                }
            }
            blobs.push((labels[seed], pixels));
        }
        blobs
    }

    /// One span a pixel, in no order.
    fn shuffled_pixels(labels: &[u8], width: usize, rng: &mut ChaCha8Rng) -> Vec<PixelSpan> {
        let span = |(at, label): (usize, &u8)| {
            let (row, start) = ((at / width) as u16, (at % width) as u16);
            PixelSpan { row, start, end: start + 1, color: ColorId(*label) }
        };
        let mut spans: Vec<PixelSpan> =
            labels.iter().enumerate().filter(|(_, label)| **label != NO_COLOR).map(span).collect();
        spans.shuffle(rng);
        spans
    }

    #[test]
    fn blobs_of_random_images_are_what_flooding_finds() {
        let mut rng = ChaCha8Rng::seed_from_u64(431);
        for _ in 0..3000 {
            let (width, height) = (rng.random_range(1..14), rng.random_range(1..14));
            let n_labels = rng.random_range(1..4);
            let label = |k: u8| if k == 0 { NO_COLOR } else { k - 1 };
            let labels: Vec<u8> =
                (0..width * height).map(|_| label(rng.random_range(0..=n_labels))).collect();
            let (blobs, flooded) = (find_blobs(&labels, width).unwrap(), flooded(&labels, width));
            assert_eq!(blobs.len(), flooded.len(), "{width} {labels:?}");
            assert_eq!(blobs_of_spans(&mut shuffled_pixels(&labels, width, &mut rng)), blobs);
            for (blob, (label, pixels)) in blobs.iter().zip(&flooded) {
                assert_eq!((blob.color.0, blob.n_pixels), (*label, pixels.len()));
                let columns = || pixels.iter().map(|at| at % width);
                let rows = || pixels.iter().map(|at| at / width);
                assert_eq!(blob.columns, (columns().min().unwrap(), columns().max().unwrap()));
                assert_eq!(blob.rows, (rows().min().unwrap(), rows().max().unwrap()));
                let mean = |sum: usize| sum as f64 / pixels.len() as f64 + 0.5;
                assert!((blob.centroid.0 - mean(columns().sum())).abs() < 1e-9);
                assert!((blob.centroid.1 - mean(rows().sum())).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn labels_that_are_no_image_are_refused() {
        for (n, width) in [(0, 0), (0, 4), (6, 0), (6, 4)] {
            assert!(find_blobs(&vec![0; n], width).is_err());
        }
        assert!(find_blobs(&[NO_COLOR; 6], 3).unwrap().is_empty());
    }
}
