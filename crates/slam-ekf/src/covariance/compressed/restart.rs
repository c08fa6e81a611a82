use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::{
    area::{CompressedCovariance, Influence},
    backlog::Backlog,
    factor::semidefinite_factor,
};
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
        self.influences.clear();
    }

    /// Hands on to the rest of the map what the area has learnt, and goes on with an area of these states only.
    pub(super) fn restart(&mut self, area: &BTreeSet<usize>) {
        self.hand_over();
        let kept: Vec<usize> = area.iter().copied().collect();
        let n = kept.len();
        let row = |i: usize| self.rows[kept[i]].expect("the new area is part of the old one");
        let local = self.local.matrix();
        let bordered = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => local[(row(i), row(j))],
            (false, false) => 0.0,
            _ => f64::from(i % n == j % n),
        });
        self.local = JointCovariance::from_matrix(bordered);
        self.rows.fill(None);
        for (row, state) in kept.iter().enumerate() {
            self.rows[*state] = Some(row);
        }
        let influence = |(i, state): (usize, &usize)| Influence { state: *state, row: n + i, step: 0.0 };
        self.influences = kept.iter().enumerate().map(influence).collect();
        self.area = kept;
    }

    /// Brings the base up to date, but for a new backlog: $`P_{ba} = P_{ba,0} Φ^T`$, $`P_{bb} = P_{bb,0} - W W^T`$ with $`W W^T = P_{ba,0} Ψ P_{ab,0}`$.
    fn hand_over(&mut self) {
        self.backlog.finish(&mut self.base);
        let given_back = self.given_back();
        let local = self.local.matrix();
        let n = self.rows.len();
        let outside: Vec<usize> = (0..n).filter(|state| self.rows[*state].is_none()).collect();
        let cross = {
            let base = self.base.matrix();
            let mut cross = DMatrix::zeros(n, self.influences.len());
            for (v, mut column) in self.influences.iter().zip(cross.column_iter_mut()) {
                for &state in &outside {
                    column[state] = base[(state, v.state)];
                }
            }
            cross
        };
        let area_rows: Vec<usize> = self.area.iter().filter_map(|state| self.rows[*state]).collect();
        let phi_transposed = DMatrix::from_fn(self.influences.len(), area_rows.len(), |v, a| {
            local[(self.influences[v].row, area_rows[a])]
        });
        let psi = DMatrix::from_fn(self.influences.len(), self.influences.len(), |v, w| {
            -local[(self.influences[v].row, self.influences[w].row)]
        });
        let theta = DVector::from_iterator(self.influences.len(), self.influences.iter().map(|v| v.step));

        self.lag += &cross * theta;
        let moved = &cross * phi_transposed;
        let mut base = self.base.matrix_mut();
        for (a, &state) in self.area.iter().enumerate() {
            for &other in &outside {
                base[(other, state)] = moved[(other, a)];
                base[(state, other)] = moved[(other, a)];
            }
            for (b, &other) in self.area.iter().enumerate() {
                base[(other, state)] = local[(area_rows[b], area_rows[a])];
            }
        }
        for &state in &outside {
            base[(state, state)] *= 1.0 + given_back;
        }
        self.backlog = Backlog::from_factor(&cross * semidefinite_factor(psi));
        for v in &mut self.influences {
            v.step = 0.0;
        }
        self.n_corrections = 0;
    }
}
