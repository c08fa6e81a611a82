//! What a map can know of the world, and what it cannot.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Matrix1, Matrix2, Matrix2x3, Vector1, Vector2};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{MotionModel, Pose2, SensorModel};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, LineDistanceSensor, MonobotMotion, Observation, OdometryMotion,
    OutlierRule, RangeBearingSensor, RelativePositionSensor, SlamError, SlamParams, laws,
    observability::ObservabilityRecorder,
};

const SEED: u64 = 21;

/// A camera at the ceiling that sees where the robot is.
struct Ceiling;

impl SensorModel for Ceiling {
    type State = Pose2<f64>;
    type Measurement = Vector2<f64>;
    fn expected(&self, robot: &Pose2<f64>) -> Vector2<f64> {
        robot.translation
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix2<f64> {
        Matrix2::identity() * 0.05 * 0.05
    }
}

/// A lap with the first `n_anchors` landmarks known, and a camera or not.
fn lap(n_anchors: usize, camera: bool) -> ObservabilityRecorder {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(10, &mut rng);
    let mut slam =
        EkfSlam::new(RangeBearingSensor::default(), SlamParams::default(), common::start()).unwrap();
    for (id, place) in landmarks.iter().enumerate().take(n_anchors) {
        slam.add_anchor(LandmarkId(id as u32), Vector2::from(*place)).unwrap();
    }
    let mut recorder = ObservabilityRecorder::new(&slam);
    let motion = OdometryMotion::default();
    for step in common::drive(40, &landmarks, &mut rng) {
        recorder.record_motion(&motion.jacobian(slam.robot(), &step.increment));
        slam.predict(&motion, &step.increment).unwrap();
        if camera {
            let jacobian: Matrix2x3<f64> = Ceiling.jacobian(slam.robot());
            let seen = step.truth.translation;
            let innovation = slam.update_robot(&Ceiling, &seen).unwrap();
            assert!(recorder.record_robot(&slam, &jacobian, &innovation.covariance));
        }
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
        let ids: Vec<LandmarkId> = step.observations.iter().filter_map(|seen| seen.label).collect();
        assert!(recorder.record(&slam, &ids));
    }
    recorder
}

fn free(recorder: &ObservabilityRecorder) -> Vec<String> {
    recorder.unobservable_directions().iter().map(ToString::to_string).collect()
}

#[test]
fn two_anchors_remove_the_unobservable_directions() {
    let mut names = free(&lap(0, false));
    names.sort_unstable();
    assert_eq!(
        names,
        ["rotation of everything", "translation of everything along x", "translation of everything along y"]
    );
    assert_eq!(free(&lap(2, false)), [""; 0]);
    assert_eq!(free(&lap(0, true)), [""; 0]);
}

#[test]
fn about_a_single_anchor_the_map_still_turns() {
    // The world turned about an anchor at (x, y) by ω is the world turned about the origin by ω and moved by ω (y, −x).
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let [x, y] = common::landmarks(10, &mut rng)[0];
    let directions = lap(1, false).unobservable_directions();
    assert_eq!(directions.len(), 1);
    let part = |name: &str| {
        directions[0].parts.iter().find(|(found, _)| *found == name).map_or(0.0, |(_, part)| *part)
    };
    let turn = part("rotation of everything");
    assert!(
        abs_diff_eq!(part("translation of everything along x"), turn * y, epsilon = 1e-6),
        "{}",
        directions[0]
    );
    assert!(
        abs_diff_eq!(part("translation of everything along y"), -turn * x, epsilon = 1e-6),
        "{}",
        directions[0]
    );
}

#[test]
fn accumulated_information_has_the_rank_of_one_linearization() {
    // A robot that stands still linearizes where it stands: three directions for two landmarks and a pose, exactly.
    let mut slam =
        EkfSlam::new(RelativePositionSensor { sigma: 0.1 }, SlamParams::default(), Pose2::new(1.0, 2.0, 0.5))
            .unwrap();
    let mut recorder = ObservabilityRecorder::new(&slam);
    let seen = |id: u32, x, y| Observation { label: Some(LandmarkId(id)), measurement: Vector2::new(x, y) };
    slam.update(&[seen(0, 2.0, 0.3), seen(1, -1.0, 4.0)], &mut KnownIdAssociation).unwrap();
    recorder.record(&slam, &[LandmarkId(0), LandmarkId(1)]);
    assert_eq!((recorder.dimension(), recorder.rank()), (7, 4));
    assert!((recorder.information() * recorder.null_space()).amax() < 1e-9 * recorder.information().amax());
}

#[test]
fn the_monobot_has_the_information_of_the_paper() {
    // Eqs. 15 and 17: J = Σ 1/s (1, −1)ᵀ(1, −1); singular in (1, 1), whatever the number of steps.
    let sensor = LineDistanceSensor { sigma: 1.0, sigma_per_meter: 0.0 };
    let motion = MonobotMotion { sigma: 1.0, sigma_per_meter: 0.0 };
    let start = (Vector1::new(0.0), Matrix1::new(1.0));
    let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), start.0, start.1).unwrap();
    let seen = [Observation { label: Some(LandmarkId(0)), measurement: Vector1::new(1.0) }];
    slam.update(&seen, &mut KnownIdAssociation).unwrap();
    let mut recorder = ObservabilityRecorder::new(&slam);
    let mut expected = 0.0;
    for _ in 0..20 {
        recorder.record_motion(&motion.jacobian(slam.robot(), &Vector1::zeros()));
        slam.predict(&motion, &Vector1::zeros()).unwrap();
        let p = slam.covariance();
        expected += 1.0 / (p[(0, 0)] - 2.0 * p[(0, 1)] + p[(1, 1)] + 1.0);
        recorder.record(&slam, &[LandmarkId(0)]);
        slam.update(&seen, &mut KnownIdAssociation).unwrap();
    }
    let j = recorder.information();
    for (place, sign) in [((0, 0), 1.0), ((0, 1), -1.0), ((1, 0), -1.0), ((1, 1), 1.0)] {
        assert_abs_diff_eq!(j[place], sign * expected, epsilon = 1e-9 * expected);
    }
    assert_eq!(recorder.rank(), 1);
}

#[test]
fn the_monobot_keeps_the_laws() {
    let line = LineDistanceSensor { sigma: 0.1, sigma_per_meter: 0.1 };
    laws::landmark_model(&line, &[Vector1::new(-1.0)], &[Vector1::new(1.0), Vector1::new(-3.0)]).unwrap();
}

#[test]
fn a_bad_measurement_of_the_robot_changes_nothing() {
    let params = SlamParams { outlier_rule: OutlierRule::Reject, ..SlamParams::default() };
    let mut slam = EkfSlam::with_start_covariance(
        RangeBearingSensor::default(),
        params,
        common::start(),
        nalgebra::Matrix3::identity() * 0.01,
    )
    .unwrap();
    let before = slam.snapshot();
    let nan = Vector2::new(f64::NAN, 0.0);
    assert!(matches!(slam.update_robot(&Ceiling, &nan), Err(SlamError::NotFinite { .. })));
    assert!(matches!(slam.update_robot(&Ceiling, &Vector2::new(50.0, 0.0)), Err(SlamError::Outlier { .. })));
    assert_eq!(slam.snapshot(), before);
    let innovation = slam.update_robot(&Ceiling, &Vector2::new(3.05, 0.0)).unwrap();
    assert!(innovation.nis < 1.0 && slam.robot().x() > 3.0 && slam.robot().x() < 3.05);
}
