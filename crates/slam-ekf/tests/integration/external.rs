//! Sensors of the pose that do not use the map: their laws, what they observe, and what is refused.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Angle, LieGroup, Manifold, MotionModel, Pose2, SensorModel, laws};
use wayfix_slam_ekf::observability::ObservabilityRecorder;
use wayfix_slam_ekf::{
    EkfSlam, ExternalError, ExternalParams, HeadingSensor, KnownIdAssociation, LocalPlane, MovedSensor,
    OdometryMotion, PoseSensor, PositionSensor, RangeBearingSensor, SlamError, SlamParams,
};

const POSITION: PositionSensor =
    PositionSensor { antenna: Vector2::new(0.4, -0.3), covariance: Matrix2::new(0.04, 0.01, 0.01, 0.09) };

fn poses() -> [Pose2<f64>; 4] {
    [(0.0, 0.0, 0.0), (3.0, -2.0, 3.1), (-50.0, 7.0, -3.1), (1.0, 1.0, 1.6)]
        .map(|(x, y, h)| Pose2::new(x, y, h))
}

fn pose_sensor() -> PoseSensor {
    PoseSensor { covariance: Matrix3::new(0.04, 0.01, 0.002, 0.01, 0.09, 0.0, 0.002, 0.0, 0.01) }
}

/// A map of a lap, without and with an uncertain start.
fn mapped() -> EkfSlam<RangeBearingSensor> {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let landmarks = common::landmarks(8, &mut rng);
    let mut slam =
        EkfSlam::new(RangeBearingSensor::default(), SlamParams::default(), common::start()).unwrap();
    for step in common::drive(40, &landmarks, &mut rng) {
        slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
    }
    slam
}

#[test]
fn external_sensors_obey_the_laws_of_sensors() {
    laws::sensor(&POSITION, &poses()).unwrap();
    laws::sensor(&HeadingSensor { variance: 0.01 }, &poses()).unwrap();
    laws::sensor(&pose_sensor(), &poses()).unwrap();
    let (motion, covariance) = (Pose2::new(0.3, 0.05, 0.4), Matrix3::identity() * 1e-3);
    laws::sensor(&MovedSensor { sensor: POSITION, motion, covariance }, &poses()).unwrap();
    laws::sensor(&MovedSensor { sensor: pose_sensor(), motion, covariance }, &poses()).unwrap();
}

/// Eq. 27 has the identity for the position where the error is in world axes: turned there, ours is the same.
#[test]
fn position_jacobian_is_the_identity_in_world_axes() {
    let sensor = PositionSensor { antenna: Vector2::zeros(), ..POSITION };
    for pose in poses() {
        let in_world = sensor.jacobian(&pose) * pose.rotation_matrix().transpose().to_homogeneous();
        assert_abs_diff_eq!(
            in_world.fixed_view::<2, 2>(0, 0).into_owned(),
            Matrix2::identity(),
            epsilon = 1e-12
        );
        assert!(in_world.column(2).norm() < 1e-12);
    }
}

#[test]
fn covariance_of_a_measured_pose_is_in_map_axes() {
    let covariance = Matrix3::from_diagonal(&Vector3::new(1.0, 1e-4, 1e-4));
    let start = Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    let wide = Matrix3::identity();
    let sensor = RangeBearingSensor::default();
    let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), start, wide).unwrap();
    slam.update_pose(&PoseSensor { covariance }, &Pose2::new(1.0, 1.0, start.heading())).unwrap();
    let moved = slam.robot().translation;
    assert!(
        abs_diff_eq!(moved.x, 0.5, epsilon = 1e-9) && abs_diff_eq!(moved.y, 1.0, epsilon = 1e-3),
        "{moved}"
    );
}

#[test]
fn one_position_sensor_makes_a_moving_robot_observable() {
    let mut slam = mapped();
    let mut recorder = ObservabilityRecorder::new(&slam);
    for step in 0..3 {
        if step > 0 {
            let increment = Pose2::new(0.5, 0.0, 0.1);
            let motion = OdometryMotion::default();
            let jacobian = motion.jacobian(slam.robot(), &increment);
            slam.predict(&motion, &increment).unwrap();
            recorder.record_motion(&nalgebra::DMatrix::from_fn(3, 3, |row, column| jacobian[(row, column)]));
        }
        let position = slam.robot().transform(&POSITION.antenna);
        let innovation = slam.update_pose(&POSITION, &position).unwrap();
        recorder.record_robot(&slam, &innovation.jacobian, &innovation.covariance);
    }
    assert_eq!(recorder.rank(), recorder.dimension());
}

#[test]
fn jump_of_a_hundred_metres_leaves_the_filter_untouched() {
    let mut slam = mapped();
    let before = slam.snapshot();
    let position = slam.robot().transform(&POSITION.antenna);
    let refused = slam.update_pose(&POSITION, &(position + Vector2::new(100.0, 0.0)));
    let Err(SlamError::Outlier { nis, threshold }) = refused else { panic!("{refused:?}") };
    // The chi-squared quantile of 0.9999 with two degrees of freedom is -2 ln(0.0001).
    assert_abs_diff_eq!(threshold, -2.0 * 1e-4_f64.ln(), epsilon = 1e-6);
    assert!(nis > threshold);
    assert_eq!(slam.snapshot(), before);
    assert!(slam.update_pose(&POSITION, &position).is_ok());
}

#[test]
fn mirrored_compass_is_rejected_and_leaves_no_trace() {
    let mut slam = mapped();
    let before = slam.snapshot();
    let heading = slam.robot().heading();
    assert!(heading.sin().abs() > 0.5, "a mirrored heading differs: {heading}");
    let compass = HeadingSensor { variance: 0.05 * 0.05 };
    let refused = slam.update_pose(&compass, &Angle::new(-heading));
    assert!(matches!(refused, Err(SlamError::Outlier { .. })), "{refused:?}");
    assert_eq!(slam.snapshot(), before);
    assert!(slam.update_pose(&compass, &Angle::new(heading)).is_ok());
}

#[test]
fn a_stated_covariance_has_noise_in_what_is_measured() {
    let params = ExternalParams::default();
    let diagonal = |x, y, heading| Some(Matrix3::from_diagonal(&Vector3::new(x, y, heading)));
    let is_refused = |stated, position, heading| {
        matches!(params.covariance(stated, position, heading), Err(ExternalError::Covariance(_)))
    };
    assert!(is_refused(diagonal(0.0, 1.0, 1.0), true, false));
    assert!(is_refused(diagonal(1.0, 1.0, 0.0), true, true));
    assert!(is_refused(diagonal(1.0, 1.0, -1.0), false, true));
    assert!(is_refused(diagonal(1.0, 1.0, 0.0), false, true));
    let text = params.covariance(diagonal(0.0, 1.0, 1.0), true, false).unwrap_err().to_string();
    assert_eq!(text, "its covariance is not positive definite (pivot 0 is 0e0)");
    for sigma in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let params = ExternalParams { position_sigma: Some(sigma), ..ExternalParams::default() };
        assert!(matches!(params.check(), Err(SlamError::Parameter { name: "external.position_sigma", .. })));
    }
    let beyond_the_pole = ExternalParams { datum: Some([100.0, 0.0]), ..ExternalParams::default() };
    assert!(matches!(beyond_the_pole.check(), Err(SlamError::Parameter { name: "external.datum", .. })));
    assert_eq!(ExternalParams::default().check(), Ok(()));
    assert!(is_refused(Some(Matrix3::new(1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0)), true, false));
    let position = diagonal(1.0, 1.0, 0.0); // of a position: it says nothing of the heading
    assert_eq!(params.covariance(position, true, false).ok(), position);
}

#[test]
fn bad_numbers_and_covariances_are_typed_errors() {
    let mut slam = mapped();
    let before = slam.snapshot();
    let here = slam.robot().translation;
    let with = |covariance| PositionSensor { covariance, ..POSITION };
    let nan = slam.update_pose(&POSITION, &Vector2::new(f64::NAN, 0.0));
    assert!(matches!(nan, Err(SlamError::NotFinite { .. })), "{nan:?}");
    for bad in [Matrix2::new(1.0, 2.0, 2.0, 1.0), -Matrix2::identity(), Matrix2::new(1.0, 0.5, -0.5, 1.0)] {
        let refused = slam.update_pose(&with(bad), &here);
        assert!(matches!(refused, Err(SlamError::NotACovariance { .. })), "{refused:?}");
    }
    let infinite = slam.update_pose(&with(Matrix2::identity() * f64::INFINITY), &here);
    assert!(matches!(infinite, Err(SlamError::NotFinite { .. })), "{infinite:?}");
    assert_eq!(slam.snapshot(), before);
}

#[test]
fn frame_datum_and_covariance_must_be_known() {
    let nothing = ExternalParams::default();
    assert!(!nothing.is_on());
    assert_eq!(nothing.check_frame("map"), Err(ExternalError::Frame("map".to_owned())));
    assert_eq!(nothing.position(48.0, 11.0), Err(ExternalError::Datum));
    assert_eq!(nothing.covariance(None, true, false), Err(ExternalError::NoCovariance));
    let known = ExternalParams {
        map_frame_ids: vec!["map".to_owned()],
        datum: Some([48.0, 11.0]),
        position_sigma: Some(2.0),
        heading_sigma: None,
    };
    assert!(known.check_frame("map").is_ok() && known.check_frame("odom").is_err());
    assert_eq!(known.covariance(None, true, false).unwrap().m11, 4.0);
    assert_eq!(known.covariance(None, true, true), Err(ExternalError::NoCovariance));
    assert_eq!(known.covariance(Some(Matrix3::identity()), true, true), Ok(Matrix3::identity()));
    assert!(known.position(48.0, 11.0).unwrap().norm() < 1e-9);
    let on_no_planet = ExternalParams { datum: Some([100.0, 0.0]), ..known };
    assert_eq!(on_no_planet.position(48.0, 11.0), Err(ExternalError::Datum));
}

/// The curvature radii at 45° by hand: M = 6367.38 km, N = 6388.84 km.
#[test]
fn local_plane_has_the_radii_of_wgs_84() {
    let plane = LocalPlane::new(45.0, 9.0).unwrap();
    let step = 1e-3_f64.to_radians();
    let east = plane.position(45.0, 9.001);
    assert!(
        abs_diff_eq!(east.x / (6_388_838.3 * 45f64.to_radians().cos() * step), 1.0, epsilon = 1e-6),
        "{east}"
    );
    let north = plane.position(45.001, 9.0);
    assert!(abs_diff_eq!(north.y / (6_367_381.8 * step), 1.0, epsilon = 1e-5), "{north}");
}

/// Odometry without noise models drifts; a position of half a metre each metre holds it.
#[test]
fn positions_hold_a_robot_without_landmarks() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let start = Pose2::new(0.0, 0.0, 0.0);
    let motion = OdometryMotion {
        heading_variance_per_meter: 1e-3,
        translation_variance_per_meter: 1e-3,
        ..OdometryMotion::default()
    };
    let mut slam = EkfSlam::new(RangeBearingSensor::default(), SlamParams::default(), start).unwrap();
    let sensor = PositionSensor { antenna: Vector2::zeros(), covariance: Matrix2::identity() * 0.25 };
    let (mut truth, mut reckoned) = (start, start);
    for _ in 0..200 {
        let increment = Pose2::new(1.0, 0.0, 0.02);
        truth = truth.compose(&increment);
        let turn = 0.02 + 1e-3_f64.sqrt() * common::normal(&mut rng);
        let measured = Pose2::new(1.0 + 1e-3_f64.sqrt() * common::normal(&mut rng), 0.0, turn);
        reckoned = reckoned.compose(&measured);
        slam.predict(&motion, &measured).unwrap();
        let fix = truth.translation + Vector2::new(common::normal(&mut rng), common::normal(&mut rng)) * 0.5;
        slam.update_pose(&sensor, &fix).unwrap();
    }
    let error = slam.robot().local(&truth).xy().norm();
    assert!(error < 1.5, "three standard deviations of one fix: {error}");
    assert!(reckoned.local(&truth).xy().norm() > error);
}
