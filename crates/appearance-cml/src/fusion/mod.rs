//! Fusion of odometry, views and other sources into one belief.

mod combine;
mod fuse;
mod likelihood;
mod params;
mod source;
mod split;

pub(crate) use combine::carried;
pub use combine::combine;
pub use fuse::fuse;
pub use likelihood::{GaussianMixtureLikelihood, UniformComponent};
pub use params::{GaussianFusionRule, MixtureFusionParams, MixtureWeighting};
pub use source::{PoseHypothesisSource, PositionFix};
