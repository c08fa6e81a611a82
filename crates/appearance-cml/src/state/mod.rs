//! Where the robot may be: weighted Gaussians over poses, moved by odometry.

mod hypothesis;
mod odometry_noise;
mod propagate;
mod separation;
mod simplify;
mod unimodal;

pub use hypothesis::PoseHypothesis;
pub use odometry_noise::OdometryNoise;
pub use propagate::propagate;
pub(crate) use propagate::transition;
pub use separation::separation_squared;
pub use simplify::{MixtureReductionParams, simplify};
pub use unimodal::{UnimodalParams, unimodal};
