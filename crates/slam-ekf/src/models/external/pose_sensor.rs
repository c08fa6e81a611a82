use nalgebra::Matrix3;
use wayfix_estimation_traits::{Pose2, SensorModel};

/// Measures the pose in the frame of the map: a camera at the ceiling, or motion capture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoseSensor {
    /// Covariance of `(x, y, θ)` in the axes of the map, m and rad, as `geometry_msgs/PoseWithCovariance` has it.
    pub covariance: Matrix3<f64>,
}

impl SensorModel for PoseSensor {
    type State = Pose2<f64>;
    type Measurement = Pose2<f64>;

    fn expected(&self, pose: &Pose2<f64>) -> Pose2<f64> {
        *pose
    }
    fn jacobian(&self, _: &Pose2<f64>) -> Matrix3<f64> {
        Matrix3::identity()
    }
    /// In the body frame of the expected pose.
    fn noise(&self, pose: &Pose2<f64>) -> Matrix3<f64> {
        let to_body = pose.rotation_matrix().transpose().to_homogeneous();
        to_body * self.covariance * to_body.transpose()
    }
}
