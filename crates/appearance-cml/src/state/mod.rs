//! Pose beliefs: weighted Gaussians, and how odometry moves them.

mod hypothesis;
mod motion;
mod odometry_noise;
mod propagate;
mod separation;
mod simplify;
mod unimodal;

pub use hypothesis::PoseHypothesis;
pub(crate) use motion::{Motion, RecordedMotion};
pub use odometry_noise::OdometryNoise;
pub use propagate::propagate;
pub use separation::separation_squared;
pub use simplify::{MixtureReductionParams, simplify};
pub use unimodal::unimodal;
