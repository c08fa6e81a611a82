use wayfix_estimation_traits::LogWeight;

use super::{ParticleSet, particle_set::equal_log_weights};
use crate::{Evidence, ParticleError, Weights};

impl<X> ParticleSet<X> {
    /// Makes the weights add up to one, and tells what their sum was.
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible. The weights stay as they are; whether to forget the measurement
    /// ([`forget_weights`](Self::forget_weights)) or to start again is the caller's decision.
    pub fn normalize(&mut self) -> Result<Evidence, ParticleError> {
        normalize(&mut self.log_weights)
    }

    /// Gives every particle the same weight, whatever it was.
    ///
    /// # Errors
    /// [`ParticleError::TooMany`] when memory runs out.
    pub fn forget_weights(&mut self) -> Result<(), ParticleError> {
        self.log_weights = equal_log_weights(self.n_particles())?;
        Ok(())
    }
}

/// Leaves log weights alone when it fails.
pub(super) fn normalize(log_weights: &mut [LogWeight]) -> Result<Evidence, ParticleError> {
    let (weights, log_sum) = Weights::with_log_sum(log_weights)?;
    for log_weight in log_weights {
        *log_weight -= log_sum;
    }
    let n_particles = weights.as_slice().len();
    Ok(Evidence {
        log_likelihood: log_sum,
        effective_sample_size: weights.effective_sample_size(),
        n_particles,
    })
}
