use rand::Rng;

use super::ParticleSet;
use crate::{
    ParticleError, Resampler,
    memory::{reserve, resize},
};

impl<X: Clone> ParticleSet<X> {
    /// Replaces the particles by `n` children, drawn by weight; all weights are equal then. The weights need not be normalized.
    ///
    /// Returns the ancestor of each child. States are cloned: keep what is heavy behind an [`Arc`](std::sync::Arc), as
    /// [`RaoBlackwellParticle`](crate::RaoBlackwellParticle) does.
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible, [`ParticleError::NoParticles`] for `n = 0`,
    /// [`ParticleError::TooMany`] when they do not fit into memory, [`ParticleError::Ancestor`] when the resampler breaks its laws. The
    /// particles are as they were.
    pub fn resample<S: Resampler, R: Rng + ?Sized>(
        &mut self,
        resampler: &S,
        n: usize,
        rng: &mut R,
    ) -> Result<&[usize], ParticleError> {
        if n == 0 {
            return Err(ParticleError::NoParticles);
        }
        let Self { states, log_weights, workspace } = self;
        workspace.weights.assign_log(log_weights)?;
        reserve(log_weights, n)?;
        workspace.states.clear();
        reserve(&mut workspace.states, n)?;
        resize(&mut workspace.ancestors, n, 0)?;
        resampler.fill(&workspace.weights, &mut workspace.ancestors, rng);
        let n_particles = states.len();
        if let Some(&ancestor) = workspace.ancestors.iter().find(|ancestor| **ancestor >= n_particles) {
            return Err(ParticleError::Ancestor { ancestor, n_particles });
        }

        let children = workspace.ancestors.iter().map(|&ancestor| states[ancestor].clone());
        workspace.states.extend(children);
        std::mem::swap(states, &mut workspace.states);
        workspace.states.clear();
        log_weights.clear();
        log_weights.resize(n, -(n as f64).ln());
        Ok(&workspace.ancestors)
    }
}
