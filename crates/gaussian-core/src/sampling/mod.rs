//! Random points from a given generator: feature `sampling`.

mod gaussian;
mod mixture;
mod motion;
mod semidefinite_factor;

pub use gaussian::GaussianSampler;
pub use motion::GaussianMotionSampler;
