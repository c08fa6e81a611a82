//! Sensors around another one pass on what association asks of it.

use nalgebra::{Matrix2, Vector2};
use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::{
    CorrelatedNoise, LandmarkModel, MountedSensor, NewLandmark, PoseWithHeadingDrift, PoseWithRangeScale,
    RangeBearing, RangeBearingSensor, RangeBearingSensorWithScale, SensorWithHeadingDrift,
};

/// Another noise for association than for the correction, and a common part.
fn inner() -> RangeBearingSensor {
    let correlated_noise = Some(CorrelatedNoise {
        independent_bearing_sigma: 0.006,
        common_bearing_sigma: 0.008,
        ..CorrelatedNoise::default()
    });
    RangeBearingSensor { bearing_sigma: 0.035, correlated_noise, ..RangeBearingSensor::default() }
}

/// Noise for the correction and for association, and the common noise of two detections.
fn noises<S: LandmarkModel<Measurement = RangeBearing>>(sensor: &S) -> [Matrix2<f64>; 3]
where
    nalgebra::DefaultAllocator: wayfix_slam_ekf::SlamAlloc<
            wayfix_slam_ekf::RobotDim<S>,
            wayfix_slam_ekf::LandmarkDim<S>,
            wayfix_slam_ekf::MeasurementDim<S>,
        >,
{
    let (a, b) = (RangeBearing::new(3.0, 0.4), RangeBearing::new(5.0, -0.2));
    [sensor.noise(&a), sensor.association_noise(&a), sensor.common_noise(&a, &b)]
}

#[test]
fn every_wrapper_has_the_noises_of_its_sensor() {
    let expected = noises(&inner());
    assert!(expected[0] != expected[1] && expected[2] != Matrix2::zeros());
    assert_eq!(noises(&SensorWithHeadingDrift(inner())), expected);
    assert_eq!(noises(&RangeBearingSensorWithScale(inner())), expected);
    let mount = Pose2::new(0.2, 0.0, 0.1);
    assert_eq!(noises(&MountedSensor { sensor: inner(), mount }), expected);
}

/// A sensor that knows an extent of its landmarks: here the sign of the bearing stands for it.
#[derive(Clone, Copy, Debug)]
struct Sided(RangeBearingSensor);

impl LandmarkModel for Sided {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = RangeBearing;

    fn expected(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> RangeBearing {
        self.0.expected(robot, landmark)
    }
    fn robot_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> nalgebra::Matrix2x3<f64> {
        self.0.robot_jacobian(robot, landmark)
    }
    fn landmark_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2<f64> {
        self.0.landmark_jacobian(robot, landmark)
    }
    fn noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        self.0.noise(measurement)
    }
    fn initialize(
        &self,
        robot: &Pose2<f64>,
        measurement: &RangeBearing,
    ) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        self.0.initialize(robot, measurement)
    }
    fn is_compatible(&self, expected: &RangeBearing, measurement: &RangeBearing) -> bool {
        expected.bearing.radians().signum() == measurement.bearing.radians().signum()
    }
    fn extended(&self, _: &Pose2<f64>, landmark: &Vector2<f64>, measurement: &RangeBearing) -> Vector2<f64> {
        landmark * measurement.range
    }
}

#[test]
fn every_wrapper_asks_its_sensor_what_fits() {
    let (left, right) = (RangeBearing::new(2.0, 0.4), RangeBearing::new(2.0, -0.4));
    let landmark = Vector2::new(1.0, 3.0);
    let pose = Pose2::new(0.0, 0.0, 0.0);
    let drifting = SensorWithHeadingDrift(Sided(inner()));
    assert!(drifting.is_compatible(&left, &left) && !drifting.is_compatible(&left, &right));
    let robot = PoseWithHeadingDrift { pose, heading_drift: 0.0 };
    assert_eq!(drifting.extended(&robot, &landmark, &left), landmark * 2.0);
    let scaled = RangeBearingSensorWithScale(Sided(inner()));
    assert!(scaled.is_compatible(&left, &left) && !scaled.is_compatible(&left, &right));
    // Ranges are twice as long as distances.
    let robot = PoseWithRangeScale { pose, log_range_scale: 2_f64.ln() };
    assert!((scaled.extended(&robot, &landmark, &left) - landmark).norm() < 1e-12);
}
