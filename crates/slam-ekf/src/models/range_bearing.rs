use std::f64::consts::PI;

use nalgebra::{Const, DMatrix, Matrix2, Matrix2x3, Vector2};
use wayfix_estimation_traits::{Angle, Manifold, Pose2, wrap_angle};

use super::{
    CorrelatedNoise, PLANAR_SYMMETRIES, planar::carried_point_jacobian, point_symmetry, pose_symmetry,
};
use crate::{LandmarkModel, NewLandmark};

/// Range and bearing of a point from the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeBearing {
    /// Metres, positive.
    pub range: f64,
    /// 0 ahead, counter-clockwise.
    pub bearing: Angle<f64>,
}

impl RangeBearing {
    /// `range` metres away at `bearing` radians.
    pub fn new(range: f64, bearing: f64) -> Self {
        Self { range, bearing: Angle::new(bearing) }
    }
    /// The point in the robot frame.
    pub fn point(&self) -> Vector2<f64> {
        let (sin, cos) = self.bearing.radians().sin_cos();
        Vector2::new(self.range * cos, self.range * sin)
    }
}

impl Manifold for RangeBearing {
    type Scalar = f64;
    type Dim = Const<2>;
    fn dim(&self) -> Const<2> {
        Const
    }
    fn retract(&self, delta: &Vector2<f64>) -> Self {
        Self::new(self.range + delta.x, self.bearing.radians() + delta.y)
    }
    fn local(&self, other: &Self) -> Vector2<f64> {
        let turn = wrap_angle(other.bearing.radians() - self.bearing.radians());
        Vector2::new(other.range - self.range, turn)
    }
}

/// Point landmarks measured in range and bearing.
///
/// $`r = ‖q‖,\; b = \operatorname{atan2}(q_y, q_x)`$ with $`q = R^T (m - t)`$, the point in the robot frame;
/// $`σ_r = σ_0 + κ r`$, because the error of every range sensor grows with distance.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_slam_ekf::{LandmarkModel, RangeBearingSensor};
/// let sensor = RangeBearingSensor::default();
/// let seen = sensor.expected(&Pose2::new(1.0, 0.0, std::f64::consts::FRAC_PI_2), &Vector2::new(1.0, 2.0));
/// assert!((seen.range - 2.0).abs() < 1e-12 && seen.bearing.radians().abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct RangeBearingSensor {
    /// Standard deviation of the range at distance zero, m.
    pub range_sigma: f64,
    /// Its increase per m.
    pub range_sigma_per_meter: f64,
    /// Standard deviation of the bearing, rad.
    pub bearing_sigma: f64,
    /// Range up to which a landmark in view is normally detected, m. It rejects no measurement; it decides which landmarks count as missed.
    pub sensor_range: f64,
    /// The same for the bearing to either side, rad.
    pub half_field_of_view: f64,
    /// Noise for data association; if not given, the noise of the correction.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub correlated_noise: Option<CorrelatedNoise>,
}

impl Default for RangeBearingSensor {
    /// A good camera or laser: 5 cm, 0.01 rad, all around.
    fn default() -> Self {
        Self {
            range_sigma: 0.05,
            range_sigma_per_meter: 0.0,
            bearing_sigma: 0.01,
            sensor_range: f64::INFINITY,
            half_field_of_view: PI,
            correlated_noise: None,
        }
    }
}

impl LandmarkModel for RangeBearingSensor {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = RangeBearing;

    fn expected(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> RangeBearing {
        let q = robot.inverse_transform(landmark);
        RangeBearing::new(q.norm(), q.y.atan2(q.x))
    }

    fn robot_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2x3<f64> {
        let q = robot.inverse_transform(landmark);
        let along = derivative_in_robot_frame(&q);
        // q moves by -δt - δθ (-q_y, q_x); turning changes the bearing only.
        Matrix2x3::new(
            -along.m11, -along.m12, 0.0, //
            -along.m21, -along.m22, -1.0,
        )
    }

    fn landmark_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2<f64> {
        derivative_in_robot_frame(&robot.inverse_transform(landmark)) * robot.rotation_matrix().transpose()
    }

    fn noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        let range_sigma = self.range_sigma + self.range_sigma_per_meter * measurement.range;
        Matrix2::from_diagonal(&Vector2::new(range_sigma.powi(2), self.bearing_sigma.powi(2)))
    }

    fn association_noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        self.correlated_noise.map_or_else(|| self.noise(measurement), |errors| errors.noise(measurement))
    }

    fn common_noise(&self, a: &RangeBearing, b: &RangeBearing) -> Matrix2<f64> {
        self.correlated_noise.map_or_else(Matrix2::zeros, |errors| errors.common_noise(a, b))
    }

    /// A range must be positive: a bearing alone does not determine a point.
    fn is_usable(&self, measurement: &RangeBearing) -> bool {
        measurement.range > 0.0 && measurement.range.is_finite() && measurement.bearing.radians().is_finite()
    }

    fn expects_detection(&self, expected: &RangeBearing) -> bool {
        expected.range <= self.sensor_range && expected.bearing.radians().abs() <= self.half_field_of_view
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
        measurement: &RangeBearing,
    ) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        let q = measurement.point();
        let by_measurement = placement_jacobian(robot, measurement);
        let turned = by_measurement.column(1).into_owned(); // a rotation of the robot moves the point like a change of the bearing
        NewLandmark {
            landmark: robot.transform(&q),
            robot_jacobian: carried_point_jacobian(robot, turned),
            covariance: by_measurement * self.noise(measurement) * by_measurement.transpose(),
        }
    }
}

/// $`∂m/∂(r, b)`$ of a point initialized by one measurement.
fn placement_jacobian(robot: &Pose2<f64>, measurement: &RangeBearing) -> Matrix2<f64> {
    let q = measurement.point();
    robot.rotation_matrix() * Matrix2::from_columns(&[q / measurement.range, Vector2::new(-q.y, q.x)])
}

/// $`∂(r, b)/∂q`$.
fn derivative_in_robot_frame(q: &Vector2<f64>) -> Matrix2<f64> {
    let squared = q.norm_squared();
    let range = squared.sqrt();
    Matrix2::new(
        q.x / range,
        q.y / range, //
        -q.y / squared,
        q.x / squared,
    )
}
