//! Gaussians learned from groups: every group has its own $`θ_j ∼ N(μ, Σ)`$, seen through noise and with gaps.

mod covariance_prior;
mod em;
mod evidence;
mod fit;
mod params;
mod posterior;

pub use covariance_prior::InverseWishart;
pub use evidence::PooledGroupEstimate;
pub use fit::{HierarchicalGaussianFit, fit_hierarchical};
pub use params::{HierarchicalGaussianParams, MeanPrior};
