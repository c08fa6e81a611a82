use super::bits::{self, BITS};
use crate::{Camera, Span};

/// One bit a pixel and colour, to take the pixels near an edge away.
#[derive(Clone, Debug)]
pub(super) struct Margin {
    n_columns: usize,
    words_per_row: usize,
    planes: Vec<Vec<u64>>,
    /// A row, or a plane, before it was eroded.
    before: Vec<u64>,
}

impl Margin {
    pub(super) fn new(camera: &Camera, n_colors: usize) -> Self {
        let n_columns = camera.width() as usize;
        let words_per_row = n_columns.div_ceil(BITS);
        let plane = vec![0; words_per_row * camera.height() as usize];
        Self { n_columns, words_per_row, planes: vec![plane; n_colors], before: Vec::new() }
    }

    pub(super) fn clear(&mut self) {
        self.planes.iter_mut().for_each(|plane| plane.fill(0));
    }

    pub(super) fn add(&mut self, span: Span) {
        let first = usize::from(span.row) * self.words_per_row;
        let words = &mut self.planes[span.color.index()][first..first + self.words_per_row];
        bits::set(words, usize::from(span.start), usize::from(span.end));
    }

    /// Leaves, in every colour, the pixels with nothing else within `reach` pixels. What is beside the image counts as more of the same.
    pub(super) fn erode(&mut self, reach: usize) {
        for plane in self.planes.iter_mut().filter(|plane| plane.iter().any(|&word| word != 0)) {
            for step in steps(reach) {
                for row in plane.chunks_mut(self.words_per_row) {
                    erode_row(row, self.n_columns, step, &mut self.before);
                }
                erode_columns(plane, self.words_per_row, step, &mut self.before);
            }
        }
    }

    /// The runs of pixels that are left, in the colours' order.
    pub(super) fn spans(&self, emit: &mut impl FnMut(Span)) {
        for (color, plane) in self.planes.iter().enumerate() {
            for (row, words) in plane.chunks(self.words_per_row).enumerate() {
                bits::runs_of_ones(words, 0, self.n_columns, |start, end| {
                    let color = crate::ColorId(color as u8);
                    emit(Span { row: row as u16, start: start as u16, end: end as u16, color });
                });
            }
        }
    }
}

/// Shifts that together reach `reach`: with all within `r` pixels seen, a shift by `2 r + 1` to both sides leaves no gap.
fn steps(reach: usize) -> impl Iterator<Item = usize> {
    let mut reached = 0;
    std::iter::from_fn(move || {
        let step = (2 * reached + 1).min(reach - reached);
        reached += step;
        (step > 0).then_some(step)
    })
}

/// Beside the image its border pixel goes on: what that one has reached lies within what the wanted one would have.
fn erode_row(row: &mut [u64], n_columns: usize, step: usize, before: &mut Vec<u64>) {
    let is_set = |row: &[u64], column: usize| row[column / BITS] >> (column % BITS) & 1 == 1;
    let beside = |set: bool| if set { u64::MAX } else { 0 };
    let (left_border, right_border) = (beside(is_set(row, 0)), beside(is_set(row, n_columns - 1)));
    before.clear();
    before.extend_from_slice(row);
    if !n_columns.is_multiple_of(BITS) {
        let padding = u64::MAX << (n_columns % BITS);
        let last = before.len() - 1;
        before[last] = before[last] & !padding | right_border & padding;
    }
    let left = |i: usize, back: usize| i.checked_sub(back).map_or(left_border, |i| before[i]);
    let right = |i: usize, ahead: usize| before.get(i + ahead).copied().unwrap_or(right_border);
    let (words, bits) = (step / BITS, step % BITS);
    for (i, out) in row.iter_mut().enumerate() {
        *out &= if bits == 0 {
            left(i, words) & right(i, words)
        } else {
            (left(i, words) << bits | left(i, words + 1) >> (BITS - bits))
                & (right(i, words) >> bits | right(i, words + 1) << (BITS - bits))
        };
    }
}

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
