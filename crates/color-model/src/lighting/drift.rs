use nalgebra::{DMatrix, DVector};
use wayfix_gaussian_core::Gaussian;

use super::LightingDrift;

impl LightingDrift {
    /// The mean after `seconds`.
    pub(super) fn move_mean(self, seconds: f64, prior: &Gaussian<DVector<f64>>, mean: &mut DVector<f64>) {
        if let Self::TowardsPrior(time_constant) = self {
            let stays = (-seconds / time_constant).exp();
            for (mean, prior) in mean.iter_mut().zip(prior.mean().iter()) {
                *mean = prior + stays * (*mean - prior);
            }
        }
    }

    /// The covariance after `seconds`. Variances that grow by a random walk are limited to `widest`.
    pub(super) fn widen(
        self,
        seconds: f64,
        prior: &Gaussian<DVector<f64>>,
        widest: impl Fn(usize) -> f64,
        covariance: &mut DMatrix<f64>,
    ) {
        match self {
            Self::RandomWalk(rate) => {
                for i in 0..covariance.nrows() {
                    let variance = &mut covariance[(i, i)];
                    *variance = (*variance + rate[i % 3] * seconds).min(widest(i)).max(*variance);
                }
            }
            Self::TowardsPrior(time_constant) => {
                let stays = (-2.0 * seconds / time_constant).exp();
                for (value, prior) in covariance.iter_mut().zip(prior.covariance().iter()) {
                    *value = prior + stays * (*value - prior);
                }
            }
        }
    }
}
