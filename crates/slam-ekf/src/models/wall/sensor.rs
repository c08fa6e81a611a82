use nalgebra::{DMatrix, Matrix2, Matrix2x3, Vector2, linalg::Cholesky};
use wayfix_estimation_traits::Pose2;

use super::{Wall, WallLine, WallMeasurement};
use crate::{
    LandmarkModel, NewLandmark,
    models::planar::{PLANAR_SYMMETRIES, pose_symmetry},
};

/// Walls measured by a laser: $`ρ' = ρ - n^T t,\; α' = α - θ`$ with $`n = (\cos α, \sin α)`$, in the frame of the sensor.
///
/// The noise of a measurement is the covariance of the line fitted to its points, plus the deviation of walls from a straight line.
/// [Andrade-Cetto 2005, Sec. 2.5; Garulli et al. 2005]
///
/// ```
/// use std::f64::consts::PI;
/// use nalgebra::Vector2;
/// use wayfix_estimation_traits::{Manifold, Pose2};
/// use wayfix_slam_ekf::{LandmarkModel, Wall, WallLine, WallSensor};
/// let wall = Wall::between(WallLine::new(2.0, 0.0), [Vector2::new(2.0, -1.0), Vector2::new(2.0, 1.0)]);
/// let seen = WallSensor::default().expected(&Pose2::new(5.0, 0.0, 0.0), &wall); // from the other side: 3 m behind
/// assert!(seen.line.local(&WallLine::new(3.0, PI)).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct WallSensor {
    /// Standard deviation of a wall's distance beyond the noise of the beams, m: skirting boards, door frames, walls that bulge.
    pub rho_sigma: f64,
    /// The same for its direction, rad.
    pub alpha_sigma: f64,
    /// Maximum gap along a wall between two pieces of the same wall, m.
    pub max_wall_gap: f64,
    /// Distance up to which the middle of a wall is normally detected, m.
    pub sensor_range: f64,
    /// The same for its direction to either side, rad.
    pub half_field_of_view: f64,
}

impl Default for WallSensor {
    /// A laser with a field of view of 180° in a building with plastered walls and doors.
    fn default() -> Self {
        Self {
            rho_sigma: 0.02,
            alpha_sigma: 0.01,
            max_wall_gap: 0.5,
            sensor_range: 8.0,
            half_field_of_view: 1.4,
        }
    }
}

impl LandmarkModel for WallSensor {
    type Robot = Pose2<f64>;
    type Landmark = Wall;
    type Measurement = WallMeasurement;

    fn expected(&self, robot: &Pose2<f64>, wall: &Wall) -> WallMeasurement {
        let rho = wall.line.about(&(robot.translation - wall.origin)).rho;
        WallMeasurement {
            line: WallLine::new(rho, wall.line.alpha - robot.heading()),
            covariance: Matrix2::zeros(),
            ends: wall.ends().map(|end| robot.inverse_transform(&end)),
        }
    }

    fn robot_jacobian(&self, robot: &Pose2<f64>, wall: &Wall) -> Matrix2x3<f64> {
        let normal = robot.rotation_matrix().tr_mul(&wall.line.normal()); // in the body frame
        Matrix2x3::new(
            -normal.x, -normal.y, 0.0, //
            0.0, 0.0, -1.0,
        )
    }

    fn landmark_jacobian(&self, robot: &Pose2<f64>, wall: &Wall) -> Matrix2<f64> {
        Matrix2::new(
            1.0,
            -wall.line.along(&(robot.translation - wall.origin)), //
            0.0,
            1.0,
        )
    }

    fn noise(&self, measurement: &WallMeasurement) -> Matrix2<f64> {
        let own = Vector2::new(self.rho_sigma.powi(2), self.alpha_sigma.powi(2));
        measurement.covariance + Matrix2::from_diagonal(&own)
    }

    /// A line in its other form, $`(-ρ, α + π)`$, has the noise $`D R D`$ with $`D = \mathrm{diag}(-1, 1)`$.
    fn noise_at_expected(
        &self,
        expected: &WallMeasurement,
        measurement: &WallMeasurement,
        noise: &Matrix2<f64>,
    ) -> Matrix2<f64> {
        let sign = if expected.line.normal_agrees_with(&measurement.line) { 1.0 } else { -1.0 };
        Matrix2::new(noise.m11, sign * noise.m12, sign * noise.m21, noise.m22)
    }

    fn is_usable(&self, measurement: &WallMeasurement) -> bool {
        let WallMeasurement { line, covariance, ends } = measurement;
        let is_finite = line.rho.is_finite()
            && line.alpha.is_finite()
            && covariance.iter().chain(ends.iter().flatten()).all(|entry| entry.is_finite());
        is_finite && (Cholesky::new(*covariance).is_some() || *covariance == Matrix2::zeros())
    }

    /// Parallel pieces far apart along their line are different walls.
    fn is_compatible(&self, expected: &WallMeasurement, measurement: &WallMeasurement) -> bool {
        measurement.overlap(expected) > -self.max_wall_gap
    }

    fn expects_detection(&self, expected: &WallMeasurement) -> bool {
        let middle = (expected.ends[0] + expected.ends[1]) * 0.5;
        middle.norm() <= self.sensor_range && middle.y.atan2(middle.x).abs() <= self.half_field_of_view
    }

    fn extended(&self, robot: &Pose2<f64>, wall: &Wall, measurement: &WallMeasurement) -> Wall {
        wall.extended_to(measurement.ends.map(|end| robot.transform(&end)))
    }

    fn symmetries(&self) -> &'static [&'static str] {
        PLANAR_SYMMETRIES
    }

    fn robot_symmetry(&self, robot: &Pose2<f64>) -> DMatrix<f64> {
        pose_symmetry(robot)
    }

    /// Turning the world about its origin turns the normal, and moves the line relative to its reference point.
    fn landmark_symmetry(&self, wall: &Wall) -> DMatrix<f64> {
        let normal = wall.line.normal();
        DMatrix::from_row_slice(2, 3, &[normal.x, normal.y, -wall.line.along(&wall.origin), 0.0, 0.0, 1.0])
    }

    fn initialize(&self, robot: &Pose2<f64>, measurement: &WallMeasurement) -> NewLandmark<Wall, Pose2<f64>> {
        let ends = measurement.ends.map(|end| robot.transform(&end));
        let origin = (ends[0] + ends[1]) * 0.5;
        let from_robot = WallLine::new(measurement.line.rho, measurement.line.alpha + robot.heading());
        let line = from_robot.about(&(origin - robot.translation));
        let lever = line.along(&(robot.translation - origin));
        let normal = measurement.line.normal();
        let by_measurement = Matrix2::new(1.0, lever, 0.0, 1.0);
        NewLandmark {
            landmark: Wall::about(origin, line, ends),
            robot_jacobian: Matrix2x3::new(
                normal.x, normal.y, lever, //
                0.0, 0.0, 1.0,
            ),
            covariance: by_measurement * self.noise(measurement) * by_measurement.transpose(),
        }
    }
}
