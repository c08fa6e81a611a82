use nalgebra::{Const, DMatrix, DefaultAllocator, Matrix1, Matrix4, OMatrix, Vector1, Vector4};
use wayfix_estimation_traits::{Jacobian, Manifold, Pose2, SensorModel, TangentMatrix};

use crate::{LandmarkDim, LandmarkModel, MeasurementDim, NewLandmark, RobotDim, SlamAlloc};

/// A pose and the heading drift of its odometry.
///
/// With wheels of unequal size, odometry reports a straight path as an arc: the heading drifts in proportion to the distance. Tangent order
/// `(x, y, θ, κ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct PoseWithHeadingDrift {
    /// Pose of the robot.
    pub pose: Pose2<f64>,
    /// κ: rotation of the robot per m beyond that of odometry, rad/m.
    pub heading_drift: f64,
}

impl Manifold for PoseWithHeadingDrift {
    type Scalar = f64;
    type Dim = Const<4>;
    fn dim(&self) -> Const<4> {
        Const
    }
    fn retract(&self, delta: &Vector4<f64>) -> Self {
        Self { pose: self.pose.retract(&delta.xyz()), heading_drift: self.heading_drift + delta.w }
    }
    fn local(&self, other: &Self) -> Vector4<f64> {
        self.pose.local(&other.pose).push(other.heading_drift - self.heading_drift)
    }
    fn chart_jacobian(&self, at: &Self) -> Matrix4<f64> {
        self.pose.chart_jacobian(&at.pose).to_homogeneous()
    }
}

/// Any sensor of a pose on a robot whose odometry drifts: its measurements do not depend on the drift.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SensorWithHeadingDrift<S>(pub S);

impl<S> LandmarkModel for SensorWithHeadingDrift<S>
where
    S: LandmarkModel<Robot = Pose2<f64>>,
    DefaultAllocator: SlamAlloc<RobotDim<S>, LandmarkDim<S>, MeasurementDim<S>>
        + SlamAlloc<Const<4>, LandmarkDim<S>, MeasurementDim<S>>,
{
    type Robot = PoseWithHeadingDrift;
    type Landmark = S::Landmark;
    type Measurement = S::Measurement;

    fn expected(&self, robot: &PoseWithHeadingDrift, landmark: &S::Landmark) -> S::Measurement {
        self.0.expected(&robot.pose, landmark)
    }
    fn robot_jacobian(
        &self,
        robot: &PoseWithHeadingDrift,
        landmark: &S::Landmark,
    ) -> Jacobian<S::Measurement, PoseWithHeadingDrift> {
        widened(&self.0.robot_jacobian(&robot.pose, landmark))
    }
    fn landmark_jacobian(
        &self,
        robot: &PoseWithHeadingDrift,
        landmark: &S::Landmark,
    ) -> OMatrix<f64, MeasurementDim<S>, LandmarkDim<S>> {
        self.0.landmark_jacobian(&robot.pose, landmark)
    }
    fn noise(&self, measurement: &S::Measurement) -> TangentMatrix<S::Measurement> {
        self.0.noise(measurement)
    }

    fn association_noise(&self, measurement: &S::Measurement) -> TangentMatrix<S::Measurement> {
        self.0.association_noise(measurement)
    }

    fn common_noise(&self, a: &S::Measurement, b: &S::Measurement) -> TangentMatrix<S::Measurement> {
        self.0.common_noise(a, b)
    }

    fn noise_at_expected(
        &self,
        expected: &S::Measurement,
        measurement: &S::Measurement,
        noise: &TangentMatrix<S::Measurement>,
    ) -> TangentMatrix<S::Measurement> {
        self.0.noise_at_expected(expected, measurement, noise)
    }
    fn is_usable(&self, measurement: &S::Measurement) -> bool {
        self.0.is_usable(measurement)
    }
    fn is_compatible(&self, expected: &S::Measurement, measurement: &S::Measurement) -> bool {
        self.0.is_compatible(expected, measurement)
    }
    fn extended(
        &self,
        robot: &PoseWithHeadingDrift,
        landmark: &S::Landmark,
        measurement: &S::Measurement,
    ) -> S::Landmark {
        self.0.extended(&robot.pose, landmark, measurement)
    }
    fn expects_detection(&self, expected: &S::Measurement) -> bool {
        self.0.expects_detection(expected)
    }
    fn symmetries(&self) -> &'static [&'static str] {
        self.0.symmetries()
    }
    fn robot_symmetry(&self, robot: &PoseWithHeadingDrift) -> DMatrix<f64> {
        self.0.robot_symmetry(&robot.pose).insert_row(3, 0.0)
    }
    fn landmark_symmetry(&self, landmark: &S::Landmark) -> DMatrix<f64> {
        self.0.landmark_symmetry(landmark)
    }
    fn initialize(
        &self,
        robot: &PoseWithHeadingDrift,
        measurement: &S::Measurement,
    ) -> NewLandmark<S::Landmark, PoseWithHeadingDrift> {
        let new = self.0.initialize(&robot.pose, measurement);
        NewLandmark {
            landmark: new.landmark,
            robot_jacobian: widened(&new.robot_jacobian),
            covariance: new.covariance,
        }
    }
}

/// Measures the heading drift of odometry, with its variance, rad²/m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadingDriftSensor(pub f64);

impl SensorModel for HeadingDriftSensor {
    type State = PoseWithHeadingDrift;
    type Measurement = Vector1<f64>;

    fn expected(&self, robot: &PoseWithHeadingDrift) -> Vector1<f64> {
        Vector1::new(robot.heading_drift)
    }
    fn noise(&self, _: &PoseWithHeadingDrift) -> Matrix1<f64> {
        Matrix1::new(self.0)
    }
}

/// A column of zeros for the drift.
fn widened<R: nalgebra::DimName>(jacobian: &OMatrix<f64, R, Const<3>>) -> OMatrix<f64, R, Const<4>>
where
    DefaultAllocator:
        nalgebra::allocator::Allocator<R, Const<3>> + nalgebra::allocator::Allocator<R, Const<4>>,
{
    OMatrix::<f64, R, Const<4>>::from_fn(|row, column| if column < 3 { jacobian[(row, column)] } else { 0.0 })
}
