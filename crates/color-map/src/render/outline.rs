use nalgebra::Vector3;

use super::view::ImagePoint;

/// A line flatter than this, rows a column, is level: across the widest image it changes by less than a rounding error of a row.
const LEVEL: f64 = 1e-16;

/// 1.5 · 2⁵², where doubles are the whole numbers.
const INTEGERS: f64 = 6_755_399_441_055_744.0;

/// The columns of a convex shape in each row, bounded by its edge lines.
///
/// Every line is a separate bound: a row's left end is the largest of the left bounds. A bound shared by two neighbours is therefore the same number
/// for both. A line is evaluated only in the rows of its edge: elsewhere, another one is tighter.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    n_columns: f64,
    /// Of the image's pixels.
    row_centers: Vec<f64>,
    edges: Vec<Edge>,
    /// The traced rows.
    rows: std::ops::Range<usize>,
    left: Vec<f64>,
    right: Vec<f64>,
    /// The same as columns.
    starts: Vec<u32>,
    ends: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Positive inside: $`a u + b v + c`$.
    line: Vector3<f64>,
    top: f64,
    bottom: f64,
}

impl Outline {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let rows = height as usize;
        Self {
            n_columns: f64::from(width),
            row_centers: (0..height).map(|row| f64::from(row) + 0.5).collect(),
            edges: Vec::new(),
            rows: 0..0,
            left: vec![0.0; rows],
            right: vec![0.0; rows],
            starts: vec![0; rows],
            ends: vec![0; rows],
        }
    }

    pub(super) fn clear(&mut self) {
        self.edges.clear();
    }

    /// Adds an edge between `ends`, on the line through `line`; the inside is to its left in a picture with rows going up.
    pub(super) fn add(&mut self, ends: (&ImagePoint, &ImagePoint), line: (&ImagePoint, &ImagePoint)) {
        if let Some((top, bottom)) = ends.0.rows_to(ends.1) {
            let line = line.0.pixel.cross(&line.1.pixel);
            self.edges.push(Edge { line, top, bottom });
        }
    }

    /// Finds the left and right ends in all rows.
    pub(super) fn trace(&mut self) {
        let (top, bottom) = self.edges.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(top, bottom), e| {
            (top.min(e.top), bottom.max(e.bottom))
        });
        self.rows = self.rows_between(top, bottom);
        self.left[self.rows.clone()].fill(0.0);
        self.right[self.rows.clone()].fill(self.n_columns);
        for i in 0..self.edges.len() {
            self.bound(self.edges[i]);
        }
        let rows = self.rows.clone();
        first_centers_from(&self.left[rows.clone()], self.n_columns, &mut self.starts[rows.clone()]);
        first_centers_from(&self.right[rows.clone()], self.n_columns, &mut self.ends[rows]);
    }

    /// Row, first column and one past the last column of every row that is not empty.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let ends = self.starts[self.rows.clone()].iter().zip(&self.ends[self.rows.clone()]);
        let rows = self.rows.clone().zip(ends);
        rows.filter(|(_, (start, end))| start < end)
            .map(|(row, (&start, &end))| (row, start as usize, end as usize))
    }

    fn bound(&mut self, Edge { line, top, bottom }: Edge) {
        let (a, b, c) = (line.x, line.y, line.z);
        if a.abs() <= LEVEL * b.abs() {
            return self.bound_rows(b, c);
        }
        let scale = -1.0 / a;
        let (at_zero, slope) = (c * scale, b * scale);
        let rows = self.rows_between(top, bottom);
        let rows = rows.start.max(self.rows.start)..rows.end.min(self.rows.end);
        if rows.is_empty() {
            return;
        }
        let centers = &self.row_centers[rows.clone()];
        if a > 0.0 {
            for (left, row) in self.left[rows].iter_mut().zip(centers) {
                let u = at_zero + slope * row;
                *left = if u > *left { u } else { *left };
            }
        } else {
            for (right, row) in self.right[rows].iter_mut().zip(centers) {
                let u = at_zero + slope * row;
                *right = if u < *right { u } else { *right };
            }
        }
    }

    /// Leaves the rows where $`b v + c > 0`$.
    fn bound_rows(&mut self, b: f64, c: f64) {
        let split = (-c / b - 0.5).ceil().clamp(0.0, self.row_centers.len() as f64) as usize;
        if b > 0.0 {
            self.rows.start = self.rows.start.max(split);
        } else if b < 0.0 {
            self.rows.end = self.rows.end.min(split);
        } else if c < 0.0 {
            self.rows.end = self.rows.start;
        }
        self.rows.end = self.rows.end.max(self.rows.start);
    }

    /// Rows of the image with centres between two rows, both included, and up to one more at either end.
    fn rows_between(&self, top: f64, bottom: f64) -> std::ops::Range<usize> {
        let height = self.row_centers.len() as f64;
        let start = (top - 0.5).clamp(0.0, height) as usize;
        let end = (bottom + 1.0).clamp(0.0, height) as usize;
        start..end.max(start)
    }
}

/// For every `u` the first column with its centre at or to the right of it.
fn first_centers_from(us: &[f64], n_columns: f64, columns: &mut [u32]) {
    for (column, u) in columns.iter_mut().zip(us) {
        // Rounds up in a way that vectorizes: a sum with `INTEGERS` has no bits left for a fraction, and its lowest bits are the whole
        // number.
        let edge = u.clamp(0.0, n_columns) - 0.5;
        let rounded = (edge + INTEGERS) - INTEGERS;
        let up = rounded + if rounded < edge { 1.0 } else { 0.0 };
        *column = (up + INTEGERS).to_bits() as u32;
    }
}
