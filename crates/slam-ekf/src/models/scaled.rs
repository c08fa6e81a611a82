use nalgebra::{Const, DMatrix, Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};
use wayfix_estimation_traits::{Manifold, MotionModel, Pose2};

use super::{RangeBearing, RangeBearingSensor};
use crate::{LandmarkModel, NewLandmark};

/// A pose and the scale of the robot's range sensor, estimated online.
///
/// Tangent order `(x, y, θ, a)`, with $`e^a`$ the factor of the sensor on every range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct PoseWithRangeScale {
    /// Pose of the robot.
    pub pose: Pose2<f64>,
    /// $`a`$; 0 for a sensor without scale error.
    pub log_range_scale: f64,
}

impl Manifold for PoseWithRangeScale {
    type Scalar = f64;
    type Dim = Const<4>;
    fn dim(&self) -> Const<4> {
        Const
    }
    fn retract(&self, delta: &Vector4<f64>) -> Self {
        Self { pose: self.pose.retract(&delta.xyz()), log_range_scale: self.log_range_scale + delta.w }
    }
    fn local(&self, other: &Self) -> Vector4<f64> {
        self.pose.local(&other.pose).push(other.log_range_scale - self.log_range_scale)
    }
    fn chart_jacobian(&self, at: &Self) -> Matrix4<f64> {
        self.pose.chart_jacobian(&at.pose).to_homogeneous()
    }
}

/// Any motion of a pose; the scale is constant.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MotionWithRangeScale<M>(pub M);

impl<M: MotionModel<State = Pose2<f64>>> MotionModel for MotionWithRangeScale<M> {
    type State = PoseWithRangeScale;
    type Control = M::Control;

    fn propagate(&self, state: &PoseWithRangeScale, control: &M::Control) -> PoseWithRangeScale {
        PoseWithRangeScale { pose: self.0.propagate(&state.pose, control), ..*state }
    }
    fn jacobian(&self, state: &PoseWithRangeScale, control: &M::Control) -> Matrix4<f64> {
        self.0.jacobian(&state.pose, control).to_homogeneous()
    }
    fn noise(&self, state: &PoseWithRangeScale, control: &M::Control) -> Matrix4<f64> {
        let mut noise = Matrix4::zeros();
        noise.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.0.noise(&state.pose, control));
        noise
    }
}

/// A range-bearing sensor whose ranges have one unknown scale factor: $`r = e^a ‖q‖`$.
///
/// Triangulation by bearings along the path determines the factor; with a start variance of zero it is constant.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct RangeBearingSensorWithScale<S = RangeBearingSensor>(pub S);

impl<S> LandmarkModel for RangeBearingSensorWithScale<S>
where
    S: LandmarkModel<Robot = Pose2<f64>, Landmark = Vector2<f64>, Measurement = RangeBearing>,
{
    type Robot = PoseWithRangeScale;
    type Landmark = Vector2<f64>;
    type Measurement = RangeBearing;

    fn expected(&self, robot: &PoseWithRangeScale, landmark: &Vector2<f64>) -> RangeBearing {
        let seen = self.0.expected(&robot.pose, landmark);
        RangeBearing { range: seen.range * robot.log_range_scale.exp(), ..seen }
    }

    fn robot_jacobian(&self, robot: &PoseWithRangeScale, landmark: &Vector2<f64>) -> Matrix2x4<f64> {
        let mut jacobian = self.0.robot_jacobian(&robot.pose, landmark).insert_column(3, 0.0);
        jacobian.row_mut(0).scale_mut(robot.log_range_scale.exp());
        jacobian.m14 = self.expected(robot, landmark).range;
        jacobian
    }

    fn landmark_jacobian(&self, robot: &PoseWithRangeScale, landmark: &Vector2<f64>) -> Matrix2<f64> {
        let mut jacobian = self.0.landmark_jacobian(&robot.pose, landmark);
        jacobian.row_mut(0).scale_mut(robot.log_range_scale.exp());
        jacobian
    }

    fn noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        self.0.noise(measurement)
    }

    fn association_noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        self.0.association_noise(measurement)
    }

    fn noise_at_expected(
        &self,
        expected: &RangeBearing,
        measurement: &RangeBearing,
        noise: &Matrix2<f64>,
    ) -> Matrix2<f64> {
        self.0.noise_at_expected(expected, measurement, noise)
    }

    fn common_noise(&self, a: &RangeBearing, b: &RangeBearing) -> Matrix2<f64> {
        self.0.common_noise(a, b)
    }

    fn is_compatible(&self, expected: &RangeBearing, measurement: &RangeBearing) -> bool {
        self.0.is_compatible(expected, measurement)
    }

    /// The landmark by the range in the scale of the inner sensor.
    fn extended(
        &self,
        robot: &PoseWithRangeScale,
        landmark: &Vector2<f64>,
        measurement: &RangeBearing,
    ) -> Vector2<f64> {
        let range = measurement.range / robot.log_range_scale.exp();
        self.0.extended(&robot.pose, landmark, &RangeBearing { range, ..*measurement })
    }

    fn is_usable(&self, measurement: &RangeBearing) -> bool {
        self.0.is_usable(measurement)
    }

    fn expects_detection(&self, expected: &RangeBearing) -> bool {
        self.0.expects_detection(expected)
    }

    fn symmetries(&self) -> &'static [&'static str] {
        self.0.symmetries()
    }

    fn robot_symmetry(&self, robot: &PoseWithRangeScale) -> DMatrix<f64> {
        self.0.robot_symmetry(&robot.pose).insert_row(3, 0.0)
    }

    fn landmark_symmetry(&self, landmark: &Vector2<f64>) -> DMatrix<f64> {
        self.0.landmark_symmetry(landmark)
    }

    fn initialize(
        &self,
        robot: &PoseWithRangeScale,
        measurement: &RangeBearing,
    ) -> NewLandmark<Vector2<f64>, PoseWithRangeScale> {
        let true_to_scale =
            RangeBearing { range: measurement.range * (-robot.log_range_scale).exp(), ..*measurement };
        let new = self.0.initialize(&robot.pose, &true_to_scale);
        let undefined = || Matrix2::repeat(f64::NAN);
        let by_measurement =
            self.landmark_jacobian(robot, &new.landmark).try_inverse().unwrap_or_else(undefined);
        let by_scale = by_measurement.column(0) * -measurement.range;
        let mut robot_jacobian = new.robot_jacobian.insert_column(3, 0.0);
        robot_jacobian.set_column(3, &by_scale);
        let covariance = by_measurement * self.noise(measurement) * by_measurement.transpose();
        NewLandmark { landmark: new.landmark, robot_jacobian, covariance }
    }
}
