use nalgebra::{DMatrix, Matrix2, Matrix2x3, Vector2};
use wayfix_estimation_traits::{Pose2, TangentMatrix};

use super::{PLANAR_SYMMETRIES, planar::carried_point_jacobian, point_symmetry, pose_symmetry};
use crate::{LandmarkModel, NewLandmark};

/// Position of a point in the robot frame, metres: x forward, y left.
pub type RelativePosition = Vector2<f64>;

/// Point landmarks measured as a position in the robot frame: $`z = R^T (m - t)`$. [Andrade-Cetto 2005, Eqs. 24–25]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RelativePositionSensor {
    /// Standard deviation of either coordinate, m.
    pub sigma: f64,
}

impl LandmarkModel for RelativePositionSensor {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = RelativePosition;

    fn expected(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> RelativePosition {
        robot.inverse_transform(landmark)
    }

    fn robot_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2x3<f64> {
        let q = robot.inverse_transform(landmark);
        Matrix2x3::new(
            -1.0, 0.0, q.y, //
            0.0, -1.0, -q.x,
        )
    }

    fn landmark_jacobian(&self, robot: &Pose2<f64>, _: &Vector2<f64>) -> Matrix2<f64> {
        robot.rotation_matrix().transpose()
    }

    fn noise(&self, _: &RelativePosition) -> TangentMatrix<RelativePosition> {
        Matrix2::identity() * self.sigma.powi(2)
    }

    fn symmetries(&self) -> &'static [&'static str] {
        PLANAR_SYMMETRIES
    }

    fn robot_symmetry(&self, robot: &Pose2<f64>) -> DMatrix<f64> {
        pose_symmetry(robot)
    }

    fn landmark_symmetry(&self, landmark: &Vector2<f64>) -> DMatrix<f64> {
        point_symmetry(landmark)
    }

    fn initialize(
        &self,
        robot: &Pose2<f64>,
        measurement: &RelativePosition,
    ) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        let turned = robot.rotation_matrix() * Vector2::new(-measurement.y, measurement.x);
        NewLandmark {
            landmark: robot.transform(measurement),
            robot_jacobian: carried_point_jacobian(robot, turned),
            covariance: self.noise(measurement), // isotropic, so rotating it changes nothing
        }
    }
}
