use std::ops::Range;

use nalgebra::DMatrix;

use crate::covariance::JointCovariance;

/// A product $`W W^T`$ that is still to be subtracted from the map. A row of `W` becomes zero once its state is settled with all others.
#[derive(Clone, Debug, Default)]
pub(super) struct DeferredCorrection {
    factor: DMatrix<f64>,
    /// All states before it are settled.
    next: usize,
}

impl DeferredCorrection {
    pub(super) fn from_factor(factor: DMatrix<f64>) -> Self {
        Self { factor, next: 0 }
    }

    pub(super) fn is_done(&self) -> bool {
        self.factor.ncols() == 0 || self.next >= self.factor.nrows()
    }

    /// The amount still to be subtracted from the entry of two states.
    pub(super) fn pending(&self, one: usize, other: usize) -> f64 {
        let n = self.factor.nrows();
        if one.max(other) < n && !self.is_done() {
            self.factor.row(one).dot(&self.factor.row(other))
        } else {
            0.0
        }
    }

    /// Settles the next states, as many as `work` multiply-adds are enough for, and at least some.
    pub(super) fn advance(&mut self, work: f64, map: &mut JointCovariance) {
        let per_column = self.factor.ncols() * (self.factor.nrows() - self.next);
        self.settle_next(FEWEST_COLUMNS.max((work / per_column as f64) as usize), map);
    }

    pub(super) fn finish(&mut self, map: &mut JointCovariance) {
        while !self.is_done() {
            self.settle_next(PANEL, map);
        }
    }

    fn settle_next(&mut self, n_columns: usize, map: &mut JointCovariance) {
        let open = self.factor.nrows() - self.next;
        let states = self.next..self.next + n_columns.min(open);
        self.settle(states.clone(), map);
        self.next = states.end;
    }

    /// Settles these states with all others.
    pub(super) fn settle(&mut self, states: Range<usize>, map: &mut JointCovariance) {
        let states = states.start.max(self.next)..states.end;
        if self.is_done() || states.end > self.factor.nrows() || states.is_empty() {
            return; // added later, or settled before
        }
        let (open, below) = (self.next, self.factor.nrows() - self.next);
        let own = self.factor.rows(states.start, states.len()).transpose();
        let mut map = map.matrix_mut();
        map.view_mut((open, states.start), (below, states.len())).gemm(
            -1.0,
            &self.factor.rows(open, below),
            &own,
            1.0,
        );
        for column in states.clone() {
            for row in (open..open + below).filter(|row| !states.contains(row) || *row > column) {
                map[(column, row)] = map[(row, column)];
            }
        }
        self.factor.rows_mut(states.start, states.len()).fill(0.0);
    }

    pub(super) fn remove(&mut self, states: &Range<usize>) {
        if states.end <= self.factor.nrows() {
            self.factor = std::mem::take(&mut self.factor).remove_rows(states.start, states.len());
            if states.start < self.next {
                self.next -= states.len().min(self.next - states.start);
            }
        }
    }
}

/// Number of columns per step when everything is settled: few enough to stay near the triangle.
const PANEL: usize = 64;
/// A product with fewer columns than this is no faster.
const FEWEST_COLUMNS: usize = 8;
