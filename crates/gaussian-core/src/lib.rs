//! Gaussians over manifolds, mixtures, covariance intersection, gating.

mod covariance;
mod error;
mod gaussian;
mod sample;

pub use covariance::{check_covariance, cholesky, symmetrize};
pub use error::GaussianError;
pub use gaussian::Gaussian;
pub use sample::Sampler;
