use nalgebra::DMatrix;
use wayfix_gaussian_core::cholesky;

use crate::CondensationError;

/// A covariance, factored: $`L^{-1} v`$ by forward substitution turns its noise into that of unit covariance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Whitener {
    rows: Vec<f64>, // the lower triangle by rows, with reciprocals on the diagonal
    pub(super) log_determinant: f64,
}

impl Whitener {
    pub(super) fn new(covariance: &DMatrix<f64>) -> Result<Self, CondensationError> {
        let factor = cholesky("feature noise", covariance)?;
        let lower = factor.l_dirty();
        let mut rows = Vec::with_capacity(covariance.nrows() * (covariance.nrows() + 1) / 2);
        let mut log_determinant = 0.0;
        for i in 0..covariance.nrows() {
            rows.extend((0..i).map(|j| lower[(i, j)]));
            rows.push(1.0 / lower[(i, i)]);
            log_determinant += 2.0 * lower[(i, i)].ln();
        }
        Ok(Self { rows, log_determinant })
    }

    /// $`v ← L^{-1} v`$.
    pub(super) fn whiten(&self, v: &mut [f64]) {
        let mut rows = self.rows.as_slice();
        for i in 0..v.len() {
            let (row, rest) = rows.split_at(i + 1);
            let dot: f64 = row[..i].iter().zip(&v[..i]).map(|(l, w)| l * w).sum();
            v[i] = (v[i] - dot) * row[i];
            rows = rest;
        }
    }
}
