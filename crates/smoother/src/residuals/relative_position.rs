use nalgebra::{Const, Matrix2, Matrix2x3, Matrix3, Matrix3x6, Vector2, Vector3};
use wayfix_estimation_traits::{Pose2, Pose3};

use crate::Residual;

/// A landmark's position measured in the frame of a robot: $`r = R^T (l - t) - z`$, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativePosition<V> {
    /// The landmark in the body frame, in metres.
    pub measured: V,
}

impl Residual for RelativePosition<Vector2<f64>> {
    type Dim = Const<2>;
    type Variables = (Pose2<f64>, Vector2<f64>);

    fn value(&self, (robot, landmark): (&Pose2<f64>, &Vector2<f64>)) -> Vector2<f64> {
        robot.inverse_transform(landmark) - self.measured
    }
    fn jacobians(&self, (robot, landmark): (&Pose2<f64>, &Vector2<f64>)) -> (Matrix2x3<f64>, Matrix2<f64>) {
        let seen = robot.inverse_transform(landmark);
        let by_robot = Matrix2x3::new(-1.0, 0.0, seen.y, 0.0, -1.0, -seen.x);
        (by_robot, robot.rotation_matrix().transpose())
    }
}

impl Residual for RelativePosition<Vector3<f64>> {
    type Dim = Const<3>;
    type Variables = (Pose3<f64>, Vector3<f64>);

    fn value(&self, (robot, landmark): (&Pose3<f64>, &Vector3<f64>)) -> Vector3<f64> {
        robot.rotation.inverse_transform_vector(&(landmark - robot.translation)) - self.measured
    }
    fn jacobians(&self, (robot, landmark): (&Pose3<f64>, &Vector3<f64>)) -> (Matrix3x6<f64>, Matrix3<f64>) {
        let seen = robot.rotation.inverse_transform_vector(&(landmark - robot.translation));
        let mut by_robot = Matrix3x6::zeros();
        by_robot.fixed_view_mut::<3, 3>(0, 0).copy_from(&-Matrix3::identity());
        by_robot.fixed_view_mut::<3, 3>(0, 3).copy_from(&seen.cross_matrix());
        (by_robot, robot.rotation.inverse().to_rotation_matrix().into_inner())
    }
}
