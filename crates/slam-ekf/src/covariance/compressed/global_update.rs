use nalgebra::{DMatrix, DVector};

use super::{
    area::{CompressedCovariance, Influence},
    deferred::DeferredCorrection,
    factor::semidefinite_factor,
};
use crate::covariance::JointCovariance;

impl CompressedCovariance {
    /// Updates the base, up to a new backlog: $`P_{ba} = B P_{va}`$, $`P_{bb} = P_{bb,0} - W W^T`$ with
    /// $`W W^T = B (I - P_{vv}) B^T`$. There are no influences then.
    pub(super) fn global_update(&mut self) {
        self.deferred.finish(&mut self.base);
        let influences = std::mem::take(&mut self.influences);
        let outside: Vec<usize> = (0..self.rows.len()).filter(|state| self.rows[*state].is_none()).collect();
        let loadings = loadings(&influences, &outside);

        let steps = DVector::from_iterator(influences.len(), influences.iter().map(|v| v.step));
        for (state, step) in outside.iter().zip((&loadings * steps).iter()) {
            self.lag[*state] += step;
        }
        self.update_base_from_area(&outside, &loadings, &influences);
        self.defer_correction(
            &outside,
            &(&loadings * semidefinite_factor(&learnt(&self.local, &influences))),
        );
        self.n_corrections = 0;
    }

    /// $`P_{aa}`$ and $`P_{ba} = B P_{va}`$.
    fn update_base_from_area(
        &mut self,
        outside: &[usize],
        loadings: &DMatrix<f64>,
        influences: &[Influence],
    ) {
        let local = self.local.matrix();
        let rows: Vec<usize> = self.area.iter().filter_map(|state| self.rows[*state]).collect();
        let with_influences =
            DMatrix::from_fn(influences.len(), rows.len(), |v, a| local[(influences[v].row, rows[a])]);
        let with_outside = loadings * with_influences;
        let mut base = self.base.matrix_mut();
        for (a, &state) in self.area.iter().enumerate() {
            for (b, &other) in outside.iter().enumerate() {
                base[(other, state)] = with_outside[(b, a)];
                base[(state, other)] = with_outside[(b, a)];
            }
            for (row, &other) in rows.iter().zip(&self.area) {
                base[(other, state)] = local[(*row, rows[a])];
            }
        }
    }

    /// Stores $`W`$, and adds the rounding allowance to the variances from which it will be subtracted.
    fn defer_correction(&mut self, outside: &[usize], square_root: &DMatrix<f64>) {
        let mut factor = DMatrix::zeros(self.rows.len(), square_root.ncols());
        for (&state, row) in outside.iter().zip(square_root.row_iter()) {
            factor.row_mut(state).copy_from(&row);
            let first = self.base.matrix()[(state, state)];
            let rounding_allowance = self.rounding_allowance(first, first - row.norm_squared());
            self.base.matrix_mut()[(state, state)] += rounding_allowance;
        }
        self.deferred = DeferredCorrection::from_factor(factor);
    }
}

/// $`B`$, the rows outside the area only.
fn loadings(influences: &[Influence], outside: &[usize]) -> DMatrix<f64> {
    let mut loadings = DMatrix::zeros(outside.len(), influences.len());
    for (v, mut column) in influences.iter().zip(loadings.column_iter_mut()) {
        for (loading, state) in column.iter_mut().zip(outside) {
            *loading = v.loadings[*state];
        }
    }
    loadings
}

/// $`I - P_{vv}`$.
fn learnt(local: &JointCovariance, influences: &[Influence]) -> DMatrix<f64> {
    let n = influences.len();
    DMatrix::from_fn(n, n, |v, w| f64::from(v == w) - local.matrix()[(influences[v].row, influences[w].row)])
}
