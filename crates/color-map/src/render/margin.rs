use std::ops::Range;

use super::bits::{self, BITS};
use crate::{ColorId, PinholeCamera, PixelSpan};

/// One bit a pixel and colour, to take the pixels near an edge away.
#[derive(Clone, Debug)]
pub(super) struct Margin {
    n_columns: usize,
    n_rows: usize,
    words_per_row: usize,
    planes: Vec<Plane>,
    /// A plane before it was eroded.
    before: Vec<u64>,
}

/// Mask of one colour.
#[derive(Clone, Debug)]
struct Plane {
    words: Vec<u64>,
    /// All others are zero.
    rows: Range<usize>,
}

impl Margin {
    pub(super) fn new(camera: &PinholeCamera, n_colors: usize) -> Self {
        let (n_columns, n_rows) = (camera.width() as usize, camera.height() as usize);
        let words_per_row = n_columns.div_ceil(BITS);
        let plane = Plane { words: vec![0; words_per_row * n_rows], rows: 0..0 };
        Self { n_columns, n_rows, words_per_row, planes: vec![plane; n_colors], before: Vec::new() }
    }

    pub(super) fn clear(&mut self) {
        for plane in &mut self.planes {
            plane.words[plane.rows.start * self.words_per_row..plane.rows.end * self.words_per_row].fill(0);
            plane.rows = 0..0;
        }
    }

    pub(super) fn add(&mut self, span: PixelSpan) {
        let row = usize::from(span.row);
        let plane = &mut self.planes[span.color.index()];
        plane.rows = if plane.rows.is_empty() {
            row..row + 1
        } else {
            plane.rows.start.min(row)..plane.rows.end.max(row + 1)
        };
        let words = &mut plane.words[row * self.words_per_row..(row + 1) * self.words_per_row];
        bits::set(words, usize::from(span.start), usize::from(span.end));
    }

    /// Keeps, in every colour, the pixels with no other colour within `reach` pixels. The image is extended by its border pixels.
    pub(super) fn erode(&mut self, reach: usize) {
        let reach = reach.min(self.n_columns.max(self.n_rows));
        for Plane { words, rows } in self.planes.iter_mut().filter(|plane| !plane.rows.is_empty()) {
            // With a row of zeros around it, if the image has one: they eat into it.
            let rows = rows.start.saturating_sub(1)..(rows.end + 1).min(self.n_rows);
            let words = &mut words[rows.start * self.words_per_row..rows.end * self.words_per_row];
            for step in steps(reach) {
                for row in words.chunks_mut(self.words_per_row) {
                    erode_row(row, self.n_columns, step);
                }
                erode_columns(words, self.words_per_row, step, &mut self.before);
            }
        }
    }

    /// The runs of pixels that are left, in the colours' order.
    pub(super) fn spans(&self, emit: &mut impl FnMut(PixelSpan)) {
        for (color, Plane { words, rows }) in self.planes.iter().enumerate() {
            for row in rows.clone() {
                let words = &words[row * self.words_per_row..(row + 1) * self.words_per_row];
                bits::runs_of_ones(words, 0, self.n_columns, |start, end| {
                    let color = ColorId(color as u8);
                    emit(PixelSpan { row: row as u16, start: start as u16, end: end as u16, color });
                });
            }
        }
    }
}

/// Shifts that together reach `reach`, each shorter than a word: with all within `r` pixels seen, a shift by `2 r + 1` to both sides leaves no gap.
fn steps(reach: usize) -> impl Iterator<Item = usize> {
    let mut reached = 0;
    std::iter::from_fn(move || {
        let step = (2 * reached + 1).min(reach - reached).min(BITS - 1);
        reached += step;
        (step > 0).then_some(step)
    })
}

/// Keeps the pixels that are also set `step` columns to the left and to the right, with `step` from 1 to 63.
///
/// Beyond the image its border pixel repeats: its present value lies within that of the exact one.
fn erode_row(row: &mut [u64], n_columns: usize, step: usize) {
    let beside = |column: usize| 0_u64.wrapping_sub(row[column / BITS] >> (column % BITS) & 1);
    let (left_border, right_border) = (beside(0), beside(n_columns - 1));
    let padding = if n_columns.is_multiple_of(BITS) { 0 } else { u64::MAX << (n_columns % BITS) };
    let last = row.len() - 1;
    row[last] |= right_border & padding;
    let mut before = left_border;
    for i in 0..row.len() {
        let here = row[i];
        let after = if i < last { row[i + 1] } else { right_border };
        row[i] &= (here << step | before >> (BITS - step)) & (here >> step | after << (BITS - step));
        before = here;
    }
    row[last] &= !padding;
}

/// Keeps the pixels that are also set `step` rows above and below; beyond the image, its border row repeats.
fn erode_columns(plane: &mut [u64], words_per_row: usize, step: usize, before: &mut Vec<u64>) {
    before.clear();
    before.extend_from_slice(plane);
    let last = plane.len() / words_per_row - 1;
    for (row, words) in plane.chunks_mut(words_per_row).enumerate() {
        let above = &before[row.saturating_sub(step) * words_per_row..];
        let below = &before[(row + step).min(last) * words_per_row..];
        for ((out, above), below) in words.iter_mut().zip(above).zip(below) {
            *out &= above & below;
        }
    }
}
