use nalgebra::{DMatrix, DVector};
use wayfix_estimation_traits::LogWeight;

use crate::{GaussianError, PooledGroupEstimate, cholesky};

/// The posterior of one group's $`θ_j`$ under $`N(μ, Σ)`$, and the log density of what the group observed.
///
/// [Bishop 2006, Eqs. 2.81-2.82 and 2.115]
pub(super) struct GroupPosterior {
    /// $`E[θ_j] - μ`$.
    pub(super) shift: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) log_evidence: LogWeight,
}

impl GroupPosterior {
    pub(super) fn new(
        group: &PooledGroupEstimate,
        mean: &DVector<f64>,
        covariance: &DMatrix<f64>,
    ) -> Result<Self, GaussianError> {
        let seen: Vec<(usize, f64, f64)> = group
            .observed()
            .filter_map(|index| group.estimate(index).map(|(value, variance)| (index, value, variance)))
            .collect();
        let n = seen.len();
        let cross = DMatrix::from_fn(n, mean.len(), |i, j| covariance[(seen[i].0, j)]);
        let innovation = DMatrix::from_fn(n, n, |i, j| {
            covariance[(seen[i].0, seen[j].0)] + if i == j { seen[i].2 } else { 0.0 }
        });
        let factor = cholesky("a group's", &innovation)?;
        // The diagonal of a Cholesky factor is positive, so these two cannot fail.
        let mut whitened_cross = cross;
        factor.l_dirty().solve_lower_triangular_mut(&mut whitened_cross);
        let mut whitened =
            DVector::from_iterator(n, seen.iter().map(|(index, value, _)| value - mean[*index]));
        factor.l_dirty().solve_lower_triangular_mut(&mut whitened);
        let log_two_pi = (2.0 * std::f64::consts::PI).ln();
        Ok(Self {
            shift: whitened_cross.tr_mul(&whitened),
            covariance: covariance - whitened_cross.tr_mul(&whitened_cross),
            log_evidence: group.log_agreement()
                - 0.5 * (whitened.norm_squared() + factor.ln_determinant() + n as f64 * log_two_pi),
        })
    }
}
