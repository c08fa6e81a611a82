//! Particle filters: resampling, KLD-sampling, auxiliary and Rao-Blackwellised particles, injection.

mod chunks;
mod error;
mod evidence;
mod filters;
mod injection;
mod kld;
mod memory;
mod rao_blackwell;
mod resampling;
mod set;
mod weights;

pub use chunks::ChunkRng;
pub use error::ParticleError;
pub use evidence::{EssBelow, Evidence, ess_below};
pub use filters::{AuxiliaryFilter, BootstrapFilter, LikelyMotion, Seeded};
pub use injection::{InjectionMonitor, InjectionParams};
pub use kld::{KldParams, KldSampling, grid_cell};
pub use rao_blackwell::RaoBlackwell;
pub use resampling::{Multinomial, Resampler, Residual, Stratified, Systematic};
pub use set::{Moments, ParticleSet};
pub use weights::Weights;

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
