use wayfix_estimation_traits::LogWeight;

use super::ParticleSet;
use crate::{ParticleError, chunks::map_chunks, memory::filled, weights::check_log_weights};

impl<X: Send> ParticleSet<X> {
    /// Multiplies every weight by a likelihood: $`\log w_i ← \log w_i + \log p(z | x_i)`$.
    ///
    /// Weights are not normalized, so several measurements may follow each other.
    ///
    /// # Errors
    /// [`ParticleError::LogWeight`] with the first particle whose log-likelihood or new log weight is NaN or positive infinity. All weights
    /// are as they were.
    pub fn reweigh(&mut self, log_likelihood: impl Fn(&X) -> LogWeight + Sync) -> Result<(), ParticleError> {
        self.reweigh_with(|| (), |(), state| log_likelihood(state))
    }

    /// [`reweigh`](Self::reweigh) with something that `prepare` makes once a chunk of particles: a curried model, working memory.
    ///
    /// What a likelihood leaves in it must not matter to the next particle.
    ///
    /// # Errors
    /// As [`reweigh`](Self::reweigh).
    pub fn reweigh_with<S>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        log_likelihood: impl Fn(&mut S, &X) -> LogWeight + Sync,
    ) -> Result<(), ParticleError> {
        let mut increments = filled(self.n_particles(), 0.0)?;
        map_chunks(&mut self.states, &mut increments, |_, states, increments| {
            let mut prepared = prepare();
            for (state, increment) in states.iter().zip(increments) {
                *increment = log_likelihood(&mut prepared, state);
            }
        });
        self.log_weights = added(&self.log_weights, &increments)?;
        Ok(())
    }
}

/// The sums, if all of them are log weights.
pub(super) fn added(
    log_weights: &[LogWeight],
    increments: &[LogWeight],
) -> Result<Vec<LogWeight>, ParticleError> {
    check_log_weights(increments)?;
    let sums: Vec<LogWeight> =
        log_weights.iter().zip(increments).map(|(l, increment)| l + increment).collect();
    check_log_weights(&sums)?;
    Ok(sums)
}
