use nalgebra::{Matrix2, Matrix2x3, Vector2};
use wayfix_estimation_traits::{Pose2, SensorModel};

/// Measures the position of an antenna, or of another point of the robot: $`h = t + R(θ)\, a`$, $`H = [R, \dot R a]`$.
///
/// With $`a = 0`$ and the error of the position in world axes these are Eqs. 26 and 27 of [Andrade-Cetto 2005]. Metres, in the frame of the map.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use wayfix_estimation_traits::{Pose2, SensorModel};
/// use wayfix_slam_ekf::PositionSensor;
/// let receiver = PositionSensor { antenna: Vector2::new(1.0, 0.0), covariance: Matrix2::identity() };
/// let quarter_turn = std::f64::consts::FRAC_PI_2;
/// let expected = receiver.expected(&Pose2::new(5.0, 2.0, quarter_turn));
/// assert!((expected - Vector2::new(5.0, 3.0)).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PositionSensor {
    /// The point that is measured, in the robot frame, m.
    pub antenna: Vector2<f64>,
    /// Covariance of the measured position, in the axes of the map, m².
    pub covariance: Matrix2<f64>,
}

impl SensorModel for PositionSensor {
    type State = Pose2<f64>;
    type Measurement = Vector2<f64>;

    fn expected(&self, pose: &Pose2<f64>) -> Vector2<f64> {
        pose.transform(&self.antenna)
    }
    fn jacobian(&self, pose: &Pose2<f64>) -> Matrix2x3<f64> {
        let rotation = pose.rotation_matrix();
        let by_heading = rotation * Vector2::new(-self.antenna.y, self.antenna.x);
        Matrix2x3::from_columns(&[rotation.column(0).into(), rotation.column(1).into(), by_heading])
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix2<f64> {
        self.covariance
    }
}
