//! Gaussians over manifolds and operations on them: fuse, transform, compare, mix, gate, draw.
//!
//! [`Gaussian<X>`](Gaussian) holds any [`Manifold`](wayfix_estimation_traits::Manifold): vectors of static or dynamic size, angles, poses,
//! `f32` or `f64`. Numbers about distributions (distances, densities, divergences) are `f64`, logarithms in nats.
//!
//! | to | use |
//! | --- | --- |
//! | fuse independent estimates, or ones that may share information | [`Gaussian::product`], [`covariance_intersection`] |
//! | transform one by a function | [`Gaussian::affine`], [`Gaussian::linearized`], [`UnscentedTransform`] |
//! | compare | [`Gaussian::mahalanobis_squared`], [`Gaussian::kl_divergence`], [`Gaussian::bhattacharyya_distance`] |
//! | take parts | [`Gaussian::marginal`], [`Gaussian::conditional`] |
//! | keep several hypotheses | [`GaussianMixture`], [`moment_matched`] |
//! | learn one from groups, each seen in part | [`fit_hierarchical`] |
//! | decide | [`ChiSquaredGate`], [`ChiSquaredBand`] |
//! | draw random points or an ellipse | [`Gaussian::sampler`], [`CovarianceEllipse`] |
//! | turn models for Kalman filters into models for particles | [`GaussianMotionSampler`], [`GaussianLikelihood`] |
//!
//! Covariances are checked where they come in ([`Gaussian::new`]) and solved by Cholesky factors.

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
mod hierarchical;
mod index_set;
mod likelihood;
mod merge;
mod mixture;
mod product;
#[cfg(feature = "sampling")]
mod sampling;
mod sigma;

pub use chi_squared::{ChiSquaredBand, ChiSquaredGate};
pub use circular::CircularMoments;
pub use covariance::{check_covariance, cholesky, symmetrize};
pub use covariance_intersection::{CovarianceIntersection, IntersectionCriterion, covariance_intersection};
pub use ellipse::CovarianceEllipse;
pub use error::{GaussianError, IterationError};
pub use gaussian::Gaussian;
pub use hierarchical::{
    HierarchicalGaussianFit, HierarchicalGaussianParams, InverseWishart, MeanPrior, PooledGroupEstimate,
    fit_hierarchical,
};
pub use likelihood::GaussianLikelihood;
pub use merge::moment_matched;
pub use mixture::{GaussianMixture, log_sum_exp};
#[cfg(feature = "sampling")]
pub use sampling::{GaussianMotionSampler, GaussianSampler};
pub use sigma::sigma_points::{SigmaPoints, UnscentedParams};
pub use sigma::unscented::{SigmaDeviation, UnscentedTransform, weighted_moments};
pub use sigma::weighted_mean::weighted_mean;
