use wayfix_estimation_traits::LogWeight;

use super::{ParticleSet, normalize::normalize};
use crate::{
    NormalizationReport, ParticleError,
    chunks::{CHUNK, map_chunks},
    memory::resize,
    weights::check_log_weights,
};

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
    /// What a likelihood leaves in it must not matter to the next particle. Memory that is dear to make may come out of a pool of the
    /// caller's.
    ///
    /// ```
    /// use wayfix_particle::ParticleSet;
    /// let mut particles = ParticleSet::new(vec![1.0, 2.0])?;
    /// particles.reweigh_with(Vec::new, |terms, x| {
    ///     terms.clear();
    ///     terms.extend([1.0, 1.5].map(|z: f64| -0.5 * (z - x).powi(2)));
    ///     terms.iter().sum()
    /// })?;
    /// assert_eq!(*particles.heaviest(), 1.0);
    /// # Ok::<(), wayfix_particle::ParticleError>(())
    /// ```
    ///
    /// # Errors
    /// As [`reweigh`](Self::reweigh).
    pub fn reweigh_with<S>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        log_likelihood: impl Fn(&mut S, &X) -> LogWeight + Sync,
    ) -> Result<(), ParticleError> {
        self.weigh(prepare, log_likelihood)?;
        std::mem::swap(&mut self.log_weights, &mut self.workspace.log_weights);
        Ok(())
    }

    /// [`reweigh_with`](Self::reweigh_with) and [`normalize`](Self::normalize), all or nothing: a measurement that no particle explains
    /// leaves the weights as they were before it.
    ///
    /// # Errors
    /// As [`reweigh`](Self::reweigh), and [`ParticleError::NoWeight`] when every particle is impossible.
    pub fn correct_with<S>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        log_likelihood: impl Fn(&mut S, &X) -> LogWeight + Sync,
    ) -> Result<NormalizationReport, ParticleError> {
        self.weigh(prepare, log_likelihood)?;
        let workspace = &mut self.workspace;
        let evidence = normalize(&mut workspace.log_weights, &mut workspace.weights)?;
        std::mem::swap(&mut self.log_weights, &mut workspace.log_weights);
        Ok(evidence)
    }

    /// The new log weights, in the workspace.
    fn weigh<S>(
        &mut self,
        prepare: impl Fn() -> S + Sync,
        log_likelihood: impl Fn(&mut S, &X) -> LogWeight + Sync,
    ) -> Result<(), ParticleError> {
        let weighed = &mut self.workspace.log_weights;
        resize(weighed, self.states.len(), 0.0)?;
        map_chunks(CHUNK, &mut self.states, weighed, |_, states, weighed| {
            let mut prepared = prepare();
            for (state, log_weight) in states.iter().zip(weighed) {
                *log_weight = log_likelihood(&mut prepared, state);
            }
        });
        add(&self.log_weights, weighed)
    }
}

/// Adds the old log weights to the increments; whether the sums are log weights.
pub(super) fn add(log_weights: &[LogWeight], increments: &mut [LogWeight]) -> Result<(), ParticleError> {
    for (increment, log_weight) in increments.iter_mut().zip(log_weights) {
        *increment += log_weight;
    }
    // An increment of NaN or infinity does not become finite by adding.
    check_log_weights(increments)
}
