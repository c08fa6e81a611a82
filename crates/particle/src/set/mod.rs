//! The weighted particles, and what one does with all of them at once.

mod advance;
mod moments;
mod normalize;
mod particle_set;
mod propagate;
mod resample;
mod reweigh;
mod workspace;

pub use moments::ParticleMoments;
pub use particle_set::ParticleSet;
