use wayfix_estimation_traits::LogWeight;

use super::ParticleSet;
use crate::{NormalizationReport, NormalizedWeights, ParticleError};

impl<X> ParticleSet<X> {
    /// Normalizes the weights to a sum of one, and returns their previous sum.
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible. The weights stay as they are; whether to forget the measurement
    /// ([`reset_weights`](Self::reset_weights)) or to start again is the caller's decision.
    pub fn normalize(&mut self) -> Result<NormalizationReport, ParticleError> {
        normalize(&mut self.log_weights, &mut self.workspace.weights)
    }

    /// Gives every particle the same weight, whatever it was.
    pub fn reset_weights(&mut self) {
        let log_share = -(self.n_particles() as f64).ln();
        self.log_weights.fill(log_share);
    }
}

/// In place, with memory for the plain weights; leaves log weights alone when it fails.
pub(super) fn normalize(
    log_weights: &mut [LogWeight],
    weights: &mut NormalizedWeights,
) -> Result<NormalizationReport, ParticleError> {
    let log_sum = weights.assign_log(log_weights)?;
    for log_weight in log_weights {
        *log_weight -= log_sum;
    }
    let n_particles = weights.as_slice().len();
    Ok(NormalizationReport {
        log_likelihood: log_sum,
        effective_sample_size: weights.effective_sample_size(),
        n_particles,
    })
}
