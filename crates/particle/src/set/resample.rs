use rand::Rng;

use super::{ParticleSet, particle_set::equal_log_weights};
use crate::{ParticleError, Resampler, memory::with_room};

impl<X: Clone> ParticleSet<X> {
    /// Replaces the particles by `n` children, drawn by weight; all weights are equal then. The weights need not be normalized.
    ///
    /// Returns the ancestor of each child. States are cloned: keep what is heavy behind an [`Arc`](std::sync::Arc), as
    /// [`RaoBlackwell`](crate::RaoBlackwell) does.
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible, [`ParticleError::NoParticles`] for `n = 0`,
    /// [`ParticleError::TooMany`] when they do not fit into memory. The particles are as they were.
    pub fn resample<S: Resampler + ?Sized, R: Rng + ?Sized>(
        &mut self,
        resampler: &S,
        n: usize,
        rng: &mut R,
    ) -> Result<Vec<usize>, ParticleError> {
        let weights = self.weights()?;
        let log_weights = equal_log_weights(n)?;
        let mut children = with_room(n)?;
        let ancestors = resampler.ancestors(&weights, n, rng)?;
        children.extend(ancestors.iter().map(|&ancestor| self.states[ancestor].clone()));
        self.states = children;
        self.log_weights = log_weights;
        Ok(ancestors)
    }
}
