use nalgebra::{DMatrix, DVector};
use wayfix_gaussian_core::Gaussian;

use super::Drift;

/// Lets a belief of the light drift for `seconds`.
pub(super) fn drift(
    drift: Drift,
    seconds: f64,
    prior: &Gaussian<DVector<f64>>,
    mean: &mut DVector<f64>,
    covariance: &mut DMatrix<f64>,
) {
    match drift {
        Drift::RandomWalk(rate) => {
            for i in 0..mean.len() {
                covariance[(i, i)] += rate[i % 3] * seconds;
            }
        }
        Drift::TowardsPrior(time_constant) => {
            let stays = (-seconds / time_constant).exp();
            for (mean, prior) in mean.iter_mut().zip(prior.mean().iter()) {
                *mean = prior + stays * (*mean - prior);
            }
            for (value, prior) in covariance.iter_mut().zip(prior.covariance().iter()) {
                *value = stays * stays * *value + (1.0 - stays * stays) * prior;
            }
        }
    }
}
