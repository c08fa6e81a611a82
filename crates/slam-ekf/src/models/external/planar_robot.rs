use wayfix_estimation_traits::{Manifold, Pose2};

use crate::{PoseWithHeadingDrift, PoseWithRangeScale};

/// A robot state that begins with a planar pose.
///
/// **Law**: the first three tangent coordinates are those of the pose, `(x, y, θ)` in the body frame.
pub trait PlanarRobot: Manifold<Scalar = f64> {
    /// The pose.
    fn pose(&self) -> &Pose2<f64>;
}

impl PlanarRobot for Pose2<f64> {
    fn pose(&self) -> &Pose2<f64> {
        self
    }
}

impl PlanarRobot for PoseWithRangeScale {
    fn pose(&self) -> &Pose2<f64> {
        &self.pose
    }
}

impl PlanarRobot for PoseWithHeadingDrift {
    fn pose(&self) -> &Pose2<f64> {
        &self.pose
    }
}
