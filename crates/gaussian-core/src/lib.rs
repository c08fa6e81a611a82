//! Gaussians over manifolds, mixtures, covariance intersection, gating.

mod chart;
mod chi_squared;
mod circular;
mod covariance;
mod covariance_intersection;
mod density;
mod divergence;
mod ellipse;
mod error;
mod gaussian;
mod index_set;
mod merge;
mod model_adapters;
mod product;
mod sample;
mod sigma_points;
mod transform;
mod unscented;
mod weighted_mean;

pub use chi_squared::{ChiSquaredBand, ChiSquaredGate};
pub use circular::CircularMoments;
pub use covariance::{check_covariance, cholesky, symmetrize};
pub use covariance_intersection::{Intersection, IntersectionCriterion, covariance_intersection};
pub use ellipse::CovarianceEllipse;
pub use error::{GaussianError, IterationError};
pub use gaussian::Gaussian;
pub use merge::moment_matched;
pub use model_adapters::{GaussianLikelihood, GaussianMotion};
pub use sample::Sampler;
pub use sigma_points::{SigmaPoints, UnscentedParams};
pub use unscented::{UnscentedTransform, weighted_moments};
pub use weighted_mean::weighted_mean;
