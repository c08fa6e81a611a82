use nalgebra::{DMatrix, DefaultAllocator, OMatrix};
use wayfix_estimation_traits::{Jacobian, LieGroup, Pose2, TangentMatrix};

use crate::{LandmarkDim, LandmarkModel, MeasurementDim, NewLandmark, RobotDim, SlamAlloc};

/// A sensor mounted on the robot: $`h(x_r ∘ c, m)`$ with $`c`$ the sensor's pose in the robot frame.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_slam_ekf::{LandmarkModel, MountedSensor, RangeBearingSensor};
/// let laser = MountedSensor { sensor: RangeBearingSensor::default(), mount: Pose2::new(3.78, 0.5, 0.0) };
/// let seen = laser.expected(&Pose2::new(0.0, 0.0, 0.0), &Vector2::new(5.78, 0.5));
/// assert!((seen.range - 2.0).abs() < 1e-12 && seen.bearing.radians() == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountedSensor<S> {
    /// The sensor in its own frame.
    pub sensor: S,
    /// Its pose in the robot frame: x forward, y left, metres and radians.
    pub mount: Pose2<f64>,
}

impl<S> LandmarkModel for MountedSensor<S>
where
    S: LandmarkModel<Robot = Pose2<f64>>,
    DefaultAllocator: SlamAlloc<RobotDim<S>, LandmarkDim<S>, MeasurementDim<S>>,
{
    type Robot = Pose2<f64>;
    type Landmark = S::Landmark;
    type Measurement = S::Measurement;

    fn expected(&self, robot: &Pose2<f64>, landmark: &S::Landmark) -> S::Measurement {
        self.sensor.expected(&robot.compose(&self.mount), landmark)
    }

    /// The sensor moves by $`\mathrm{Ad}_{c^{-1}}`$ times the motion of the robot, each in its own frame.
    fn robot_jacobian(
        &self,
        robot: &Pose2<f64>,
        landmark: &S::Landmark,
    ) -> Jacobian<S::Measurement, Pose2<f64>> {
        self.sensor.robot_jacobian(&robot.compose(&self.mount), landmark) * self.mount.inverse().adjoint()
    }

    fn landmark_jacobian(
        &self,
        robot: &Pose2<f64>,
        landmark: &S::Landmark,
    ) -> OMatrix<f64, MeasurementDim<S>, LandmarkDim<S>> {
        self.sensor.landmark_jacobian(&robot.compose(&self.mount), landmark)
    }

    fn noise(&self, measurement: &S::Measurement) -> TangentMatrix<S::Measurement> {
        self.sensor.noise(measurement)
    }

    fn association_noise(&self, measurement: &S::Measurement) -> TangentMatrix<S::Measurement> {
        self.sensor.association_noise(measurement)
    }

    fn noise_at_expected(
        &self,
        expected: &S::Measurement,
        measurement: &S::Measurement,
        noise: &TangentMatrix<S::Measurement>,
    ) -> TangentMatrix<S::Measurement> {
        self.sensor.noise_at_expected(expected, measurement, noise)
    }

    fn common_noise(&self, a: &S::Measurement, b: &S::Measurement) -> TangentMatrix<S::Measurement> {
        self.sensor.common_noise(a, b)
    }

    fn is_usable(&self, measurement: &S::Measurement) -> bool {
        self.sensor.is_usable(measurement)
    }

    fn is_compatible(&self, expected: &S::Measurement, measurement: &S::Measurement) -> bool {
        self.sensor.is_compatible(expected, measurement)
    }

    fn extended(
        &self,
        robot: &Pose2<f64>,
        landmark: &S::Landmark,
        measurement: &S::Measurement,
    ) -> S::Landmark {
        self.sensor.extended(&robot.compose(&self.mount), landmark, measurement)
    }

    fn expects_detection(&self, expected: &S::Measurement) -> bool {
        self.sensor.expects_detection(expected)
    }

    fn symmetries(&self) -> &'static [&'static str] {
        self.sensor.symmetries()
    }

    fn robot_symmetry(&self, robot: &Pose2<f64>) -> DMatrix<f64> {
        self.sensor.robot_symmetry(robot)
    }

    fn landmark_symmetry(&self, landmark: &S::Landmark) -> DMatrix<f64> {
        self.sensor.landmark_symmetry(landmark)
    }

    fn initialize(
        &self,
        robot: &Pose2<f64>,
        measurement: &S::Measurement,
    ) -> NewLandmark<S::Landmark, Pose2<f64>> {
        let new = self.sensor.initialize(&robot.compose(&self.mount), measurement);
        NewLandmark { robot_jacobian: new.robot_jacobian * self.mount.inverse().adjoint(), ..new }
    }
}
