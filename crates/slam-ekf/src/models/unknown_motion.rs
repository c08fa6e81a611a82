use nalgebra::Matrix3;
use wayfix_estimation_traits::{MotionModel, Pose2};

/// An interval for which no record gives the motion: the mean stays, with a covariance in the body frame.
#[derive(Clone, Copy, Debug)]
pub struct UnknownMotion(pub Matrix3<f64>);

impl MotionModel for UnknownMotion {
    type State = Pose2<f64>;
    type Control = ();

    fn propagate(&self, pose: &Pose2<f64>, (): &()) -> Pose2<f64> {
        *pose
    }
    fn jacobian(&self, _: &Pose2<f64>, (): &()) -> Matrix3<f64> {
        Matrix3::identity()
    }
    fn noise(&self, _: &Pose2<f64>, (): &()) -> Matrix3<f64> {
        self.0
    }
}
