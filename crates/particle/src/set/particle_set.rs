use rand::Rng;
use wayfix_estimation_traits::LogWeight;

use super::workspace::Workspace;
use crate::{
    NormalizedWeights, ParticleError,
    memory::{filled, with_capacity},
    weights::check_log_weights,
};

/// Weighted particles: $`p(x) ≈ \sum_i w_i δ(x - x_i)`$, with weights as logarithms in nats.
///
/// One step of a filter reads like the papers: [`propagate`](Self::propagate), [`reweigh`](Self::reweigh),
/// [`normalize`](Self::normalize), [`resample`](Self::resample). There is always at least one particle, and no log weight is ever NaN or
/// positive infinity; $`-∞`$ is an impossible particle.
///
/// ```
/// use rand::{RngExt, SeedableRng};
/// use wayfix_particle::{ParticleSet, SystematicResampler};
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
/// let mut particles = ParticleSet::from_fn(1000, |rng| rng.random_range(0.0..10.0), &mut rng)?;
/// particles.propagate(|x, rng| *x += 1.0 + rng.random_range(-0.1..0.1), &mut rng);
/// particles.reweigh(|x| -0.5 * ((x - 4.0) / 0.2_f64).powi(2))?; // measured at 4, give or take 0.2
/// let evidence = particles.normalize()?;
/// assert!(evidence.effective_share() < 0.5);
/// particles.resample(&SystematicResampler, 500, &mut rng)?;
/// assert!(particles.states().iter().all(|x| (x - 4.0).abs() < 1.5));
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParticleSet<X> {
    pub(crate) states: Vec<X>,
    pub(crate) log_weights: Vec<LogWeight>,
    pub(super) workspace: Workspace<X>,
}

impl<X> ParticleSet<X> {
    /// Particles of equal weight.
    ///
    /// # Errors
    /// [`ParticleError::NoParticles`] when there are none.
    pub fn new(states: Vec<X>) -> Result<Self, ParticleError> {
        let log_weights = equal_log_weights(states.len())?;
        Ok(Self::from_parts(states, log_weights))
    }

    /// Particles with log weights in nats, which need not be normalized.
    ///
    /// # Errors
    /// When the lists are empty or differ in length, or a log weight is NaN or positive infinity.
    pub fn from_log_weights(states: Vec<X>, log_weights: Vec<LogWeight>) -> Result<Self, ParticleError> {
        if states.len() != log_weights.len() {
            return Err(ParticleError::Lengths { states: states.len(), log_weights: log_weights.len() });
        }
        if states.is_empty() {
            return Err(ParticleError::NoParticles);
        }
        check_log_weights(&log_weights)?;
        Ok(Self::from_parts(states, log_weights))
    }

    /// `n` particles of equal weight from a prior.
    ///
    /// # Errors
    /// [`ParticleError::NoParticles`] for zero, [`ParticleError::TooMany`] when they do not fit into memory.
    pub fn from_fn<R: Rng + ?Sized>(
        n: usize,
        mut draw: impl FnMut(&mut R) -> X,
        rng: &mut R,
    ) -> Result<Self, ParticleError> {
        let log_weights = equal_log_weights(n)?;
        let mut states = with_capacity(n)?;
        states.extend((0..n).map(|_| draw(rng)));
        Ok(Self::from_parts(states, log_weights))
    }

    /// The caller vouches for equal lengths, at least one, and log weights that are neither NaN nor positive infinity.
    pub(crate) fn from_parts(states: Vec<X>, log_weights: Vec<LogWeight>) -> Self {
        Self { states, log_weights, workspace: Workspace::default() }
    }

    /// How many particles there are; never 0.
    pub fn n_particles(&self) -> usize {
        self.states.len()
    }
    /// The states.
    pub fn states(&self) -> &[X] {
        &self.states
    }
    /// The states, for changing them in place. Weights stay.
    pub fn states_mut(&mut self) -> &mut [X] {
        &mut self.states
    }
    /// The log weights in nats, in the order of the states.
    pub fn log_weights(&self) -> &[LogWeight] {
        &self.log_weights
    }
    /// States with their log weights.
    pub fn iter(&self) -> impl Iterator<Item = (&X, LogWeight)> {
        self.states.iter().zip(self.log_weights.iter().copied())
    }
    /// The state with the largest weight, the first of several.
    pub fn heaviest(&self) -> &X {
        let log_weights = &self.log_weights;
        let best = (1..log_weights.len())
            .fold(0, |best, i| if log_weights[i] > log_weights[best] { i } else { best });
        &self.states[best]
    }
    /// The normalized weights.
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when all are zero.
    pub fn weights(&self) -> Result<NormalizedWeights, ParticleError> {
        NormalizedWeights::from_log(&self.log_weights)
    }
    /// $`1 / \sum_i w_i^2`$ of the normalized weights; 0 when no particle is possible.
    pub fn effective_sample_size(&self) -> f64 {
        self.weights().map_or(0.0, |weights| weights.effective_sample_size())
    }
}

/// $`-\log n`$ for each.
pub(super) fn equal_log_weights(n: usize) -> Result<Vec<LogWeight>, ParticleError> {
    if n == 0 {
        return Err(ParticleError::NoParticles);
    }
    filled(n, -(n as f64).ln())
}
