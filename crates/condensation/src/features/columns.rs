//! Sums over the columns of a band of rows, moved down a scene by adding and taking away single rows.

use crate::ViewGrid;

/// `N` integer sums of every column of the scene, over the rows of one row of views. Integers, so that moving loses nothing.
pub(super) struct ColumnSums<const N: usize> {
    sums: Vec<[u64; N]>,
}

impl<const N: usize> ColumnSums<N> {
    /// Calls `job(grid_row, column_sums)` for every row of views, where `terms(x, y)` is what the pixel adds.
    pub(super) fn for_each_band(
        views: &ViewGrid,
        terms: impl Fn(usize, usize) -> [u64; N],
        mut job: impl FnMut(usize, &[[u64; N]]),
    ) {
        let (width, height) = (views.scene_size().0, views.view_size().1);
        let mut band = Self { sums: vec![[0; N]; width] };
        let mut covered = 0..0;
        for (row, &top) in views.tops().iter().enumerate() {
            let wanted = top..top + height;
            (covered.end..wanted.end).for_each(|y| band.add(y, &terms));
            (covered.start..wanted.start).for_each(|y| band.subtract(y, &terms));
            covered = wanted;
            job(row, &band.sums);
        }
    }

    fn add(&mut self, y: usize, terms: &impl Fn(usize, usize) -> [u64; N]) {
        for (x, sums) in self.sums.iter_mut().enumerate() {
            for (sum, term) in sums.iter_mut().zip(terms(x, y)) {
                *sum += term;
            }
        }
    }

    fn subtract(&mut self, y: usize, terms: &impl Fn(usize, usize) -> [u64; N]) {
        for (x, sums) in self.sums.iter_mut().enumerate() {
            for (sum, term) in sums.iter_mut().zip(terms(x, y)) {
                *sum -= term;
            }
        }
    }
}
