//! Blocked kernels on the lower triangle: nearly all of the cost of a large map.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixViewMut};

/// Columns that one matrix product handles: wide enough for the product to be fast, narrow enough to waste little of the triangle.
const PANEL: usize = 64;
/// Columns solved one by one between two matrix products.
const SOLVE_PANEL: usize = 8;
/// Side of the tiles that are mirrored: two of them, 2 kB each, stay in the nearest cache.
const MIRROR_TILE: usize = 16;

/// `P ← P − W Wᵀ` on the lower triangle.
pub(super) fn subtract_square_from_lower(p: &mut DMatrixViewMut<'_, f64>, w: &DMatrix<f64>) {
    let n = p.nrows();
    let w_transposed = w.transpose();
    for panel in panels(n, PANEL) {
        let below = n - panel.start;
        p.view_mut((panel.start, panel.start), (below, panel.len())).gemm(
            -1.0,
            &w.rows(panel.start, below),
            &w_transposed.columns(panel.start, panel.len()),
            1.0,
        );
    }
}

/// Copies the lower triangle onto the upper one, tile by tile: of a row of the upper triangle every entry lies in another cache line.
pub(super) fn mirror_lower(p: &mut DMatrixViewMut<'_, f64>) {
    let n = p.nrows();
    for columns in panels(n, MIRROR_TILE) {
        for rows in panels(n, MIRROR_TILE).skip(columns.start / MIRROR_TILE + 1) {
            let (mut source, mut target) = p.columns_range_pair_mut(columns.clone(), rows.clone());
            let source = source.rows_mut(rows.start, rows.len());
            target.rows_mut(columns.start, columns.len()).tr_copy_from(&source);
        }
        for column in columns.clone() {
            for row in column + 1..columns.end {
                p[(column, row)] = p[(row, column)];
            }
        }
    }
}

/// `X ← X L⁻ᵀ` for a lower-triangular `L`.
pub(super) fn solve_right_transposed(x: &mut DMatrix<f64>, l: &DMatrix<f64>) {
    for panel in panels(l.ncols(), SOLVE_PANEL) {
        let (done, mut open) = x.columns_range_pair_mut(0..panel.start, panel.clone());
        open.gemm(-1.0, &done, &l.view((panel.start, 0), (panel.len(), panel.start)).transpose(), 1.0);
        for column in 0..panel.len() {
            for earlier in 0..column {
                let factor = l[(panel.start + column, panel.start + earlier)];
                let (from, mut to) = open.columns_range_pair_mut(earlier, column);
                to.axpy(-factor, &from, 1.0);
            }
            open.column_mut(column).unscale_mut(l[(panel.start + column, panel.start + column)]);
        }
    }
}

fn panels(n: usize, width: usize) -> impl Iterator<Item = Range<usize>> {
    (0..n).step_by(width).map(move |start| start..(start + width).min(n))
}
