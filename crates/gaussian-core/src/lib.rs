//! Gaussians over manifolds, mixtures, covariance intersection, gating.

mod error;
mod gaussian;

pub use error::GaussianError;
pub use gaussian::Gaussian;
