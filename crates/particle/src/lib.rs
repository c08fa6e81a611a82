//! Particle filters: a weighted set of samples, and what the papers do with it.
//!
//! A filter is written as its paper writes it, out of steps on a [`ParticleSet`]:
//!
//! | step | method |
//! | --- | --- |
//! | draw from the motion model | [`ParticleSet::propagate`] |
//! | multiply by a likelihood | [`ParticleSet::reweigh`], or [`ParticleSet::correct_with`] to normalize as well |
//! | both in one, by a proposal of your own | [`ParticleSet::advance_with`] |
//! | normalize; how well was the measurement explained? | [`ParticleSet::normalize`], [`NormalizationReport`] |
//! | is it time to resample? | [`NormalizationReport::effective_share`] |
//! | to how many particles? | [`ParticleSet::kld_size`] with [`KldSampling`] |
//! | resample | [`ParticleSet::resample`] by [`SystematicResampler`], [`StratifiedResampler`], [`ResidualResampler`], [`MultinomialResampler`] or your own [`Resampler`] |
//! | where is it? | [`ParticleSet::moments`], [`ParticleSet::expectation`], [`ParticleSet::heaviest`] |
//!
//! [`BootstrapFilter`] puts the steps together for models that implement [`SampleMotion`](wayfix_estimation_traits::SampleMotion) and
//! [`LikelihoodModel`](wayfix_estimation_traits::LikelihoodModel); [`AuxiliaryFilter`] takes a
//! [`MotionModel`](wayfix_estimation_traits::MotionModel) with Gaussian noise.
//! [`RaoBlackwellParticle`] particles carry a part of the state in closed form and share it until it changes;
//! [`ParticleSet::sample_and_condition`] moves and weighs them, [`map_conditionals`] changes what they share.
//!
//! * Weights are logarithms in nats. $`-∞`$ is an impossible particle; NaN and positive infinity are refused with the index of the particle.
//!   When no particle is possible, that is an error ([`ParticleError::NoWeight`]) and never a silent start from equal weights.
//! * A call that fails leaves the particles as they were.
//! * Every function that draws takes a generator. What runs on all particles gives each chunk of 32 a ChaCha8 stream: the seed is 32
//!   bytes of the caller's generator, the stream number that of the chunk. Results are the same bits for any number of threads, with the
//!   feature `parallel` and without.
//!
//! ```
//! use rand::{RngExt, SeedableRng};
//! use wayfix_particle::{ParticleSet, SystematicResampler};
//!
//! let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
//! let mut particles = ParticleSet::from_fn(1000, |rng| rng.random_range(0.0..20.0), &mut rng)?; // metres along a corridor
//! for truth in [3.0, 4.0, 5.0] {
//!     particles.propagate(|x, rng| *x += 1.0 + rng.random_range(-0.2..0.2), &mut rng);
//!     particles.reweigh(|x| -0.5 * ((x - truth) / 0.3_f64).powi(2))?;
//!     if particles.normalize()?.effective_share() < 0.5 {
//!         particles.resample(&SystematicResampler, 1000, &mut rng)?;
//!     }
//! }
//! let moments = particles.moments(|x| nalgebra::Vector1::new(*x))?;
//! assert!((moments.mean[0] - 5.0).abs() < 0.2);
//! # Ok::<(), wayfix_particle::ParticleError>(())
//! ```

mod chunks;
mod error;
mod evidence;
mod filters;
mod kld;
pub mod laws;
mod memory;
mod rao_blackwell;
mod resampling;
mod set;
mod weights;

pub use chunks::ParticleChunkRng;
pub use error::ParticleError;
pub use evidence::NormalizationReport;
pub use filters::{AuxiliaryFilter, BootstrapFilter};
pub use kld::{KldParams, KldSampling, grid_cell};
pub use rao_blackwell::{RaoBlackwellParticle, map_conditionals};
pub use resampling::{
    MultinomialResampler, Resampler, ResidualResampler, StratifiedResampler, SystematicResampler,
};
pub use set::{ParticleMoments, ParticleSet};
pub use weights::NormalizedWeights;

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
