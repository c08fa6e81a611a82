//! How what odometry, views and others say of the pose becomes one belief.

mod combine;
mod fuse;
mod heading;
mod params;
mod source;
mod split;

pub use combine::combine;
pub use fuse::fuse;
pub(crate) use heading::update_heading;
pub use params::{FusionParams, GaussianFusionRule, MixtureWeighting};
pub use source::{PoseSource, PositionFix};
