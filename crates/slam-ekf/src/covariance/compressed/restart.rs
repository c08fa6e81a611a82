use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::{area::CompressedCovariance, backlog::Backlog, factor::semidefinite_factor};
use crate::covariance::JointCovariance;

impl CompressedCovariance {
    /// The whole covariance.
    pub(in crate::covariance) fn matrix(&self) -> DMatrix<f64> {
        let mut settled = self.clone();
        settled.hand_over();
        settled.backlog.finish(&mut settled.base);
        settled.base.matrix().into_owned()
    }

    /// Takes the whole map for the area: nothing is outside, so nothing is deferred.
    pub(super) fn unite(&mut self) {
        self.hand_over();
        self.backlog.finish(&mut self.base);
        self.local = self.base.clone();
        let n = self.rows.len();
        self.rows = (0..n).map(Some).collect();
        self.area = (0..n).collect();
    }

    /// Hands on to the rest of the map what the area has learnt, and goes on with an area of these states only.
    pub(super) fn restart(&mut self, area: &BTreeSet<usize>) {
        self.hand_over();
        self.area = area.iter().copied().collect();
        let n = self.area.len();
        let base = self.base.matrix();
        let kept = DMatrix::from_fn(n, n, |i, j| base[(self.area[i], self.area[j])]);
        self.local = JointCovariance::from_matrix(kept);
        self.rows.fill(None);
        for (row, state) in self.area.iter().enumerate() {
            self.rows[*state] = Some(row);
        }
        self.add_influences(&self.area.clone());
    }

    /// Brings the base up to date, but for a new backlog: $`P_{ba} = B P_{va}`$, $`P_{bb} = P_{bb,0} - W W^T`$ with
    /// $`W W^T = B (I - P_{vv}) B^T`$. There are no influences then.
    fn hand_over(&mut self) {
        self.backlog.finish(&mut self.base);
        let n = self.rows.len();
        let influences = std::mem::take(&mut self.influences);
        let outside: Vec<usize> = (0..n).filter(|state| self.rows[*state].is_none()).collect();
        let inside: Vec<usize> = self.area.iter().filter_map(|state| self.rows[*state]).collect();
        let mut loadings = DMatrix::zeros(outside.len(), influences.len());
        for (v, mut column) in influences.iter().zip(loadings.column_iter_mut()) {
            for (loading, state) in column.iter_mut().zip(&outside) {
                *loading = v.loadings[*state];
            }
        }
        let local = self.local.matrix();
        let at = |v: usize, row: usize| local[(influences[v].row, row)];
        let with_area = DMatrix::from_fn(influences.len(), inside.len(), |v, a| at(v, inside[a]));
        let learnt = DMatrix::from_fn(influences.len(), influences.len(), |v, w| {
            f64::from(v == w) - at(v, influences[w].row)
        });
        let steps = DVector::from_iterator(influences.len(), influences.iter().map(|v| v.step));

        let outside_steps = &loadings * steps;
        let moved = &loadings * with_area;
        let square_root = &loadings * semidefinite_factor(&learnt);
        let mut factor = DMatrix::zeros(n, square_root.ncols());
        for (b, &state) in outside.iter().enumerate() {
            self.lag[state] += outside_steps[b];
            factor.row_mut(state).copy_from(&square_root.row(b));
            let first = self.base.matrix()[(state, state)];
            let now = first - square_root.row(b).norm_squared();
            self.base.matrix_mut()[(state, state)] += self.given_back(first, now);
        }
        let mut base = self.base.matrix_mut();
        for (a, &state) in self.area.iter().enumerate() {
            for (b, &other) in outside.iter().enumerate() {
                base[(other, state)] = moved[(b, a)];
                base[(state, other)] = moved[(b, a)];
            }
            for (row, &other) in inside.iter().zip(&self.area) {
                base[(other, state)] = local[(*row, inside[a])];
            }
        }
        self.backlog = Backlog::from_factor(factor);
        self.n_corrections = 0;
    }
}
