use approx::assert_abs_diff_eq;
use nalgebra::Vector2;
use wayfix_estimation_traits::{Angle, Manifold, MotionModel};
use wayfix_sensor_log::Stamp;
use wayfix_slam_ekf::{
    HeadingDriftSensor, HeadingSensor, KnownIdAssociation, LandmarkMerge, OdometryMotion, PoseSensor,
    PositionSensor, SensorWithHeadingDrift, SlamParams, WallLine,
};

use super::*;
use crate::walls::relative_motion::RelativeMotion;

const DRIFT: f64 = 0.02;

/// A robot with an uncertain pose and drift.
fn start() -> (EkfSlam<WallModel>, WallBatch) {
    let sensor =
        SensorWithHeadingDrift(MountedSensor { sensor: WallSensor::default(), mount: Pose2::identity() });
    let state = PoseWithHeadingDrift { pose: Pose2::new(1.0, 2.0, 1.4), heading_drift: DRIFT };
    let variances = nalgebra::Vector4::new(0.02, 0.03, 0.01, 0.01).map(|sigma| sigma * sigma);
    let covariance = Matrix4::from_diagonal(&variances);
    let filter =
        EkfSlam::with_start_covariance(sensor, SlamParams::default(), state, covariance).expect("a filter");
    let batch = WallBatch::new(&filter);
    (filter, batch)
}

fn motion(increment: Pose2<f64>) -> RelativeMotion {
    moved(DRIFT, increment)
}

fn moved(drift: f64, increment: Pose2<f64>) -> RelativeMotion {
    RelativeMotion::default()
        .then(&OdometryMotion::default(), drift, &increment)
        .with_added_covariance(&(Matrix3::identity() * 1e-4))
}

fn predict(filter: &mut EkfSlam<WallModel>, batch: &mut WallBatch, motion: &RelativeMotion) {
    let before = *filter.robot();
    filter.predict(motion, &motion.motion).expect("a motion");
    let jacobian = motion.jacobian(&before, &motion.motion);
    batch.predicted(&before, filter.robot(), &jacobian, &motion.noise(&before, &motion.motion));
}

/// Takes a measurement after a further motion.
fn measure(
    filter: &mut EkfSlam<WallModel>,
    batch: &mut WallBatch,
    measurement: MapMeasurement,
    rest: &RelativeMotion,
) {
    let noisy = measurement.with_motion_noise(&filter.robot().pose, rest.motion, rest.covariance);
    filter.update_moved(&measurement, rest.motion, rest.covariance).expect("a measurement");
    batch.measured(filter, &noisy, rest.motion);
}

/// The batch's pose at the newest keyframe.
fn solved(filter: &EkfSlam<WallModel>, batch: &mut WallBatch) -> Pose2<f64> {
    let estimate = StampedEstimate {
        stamp: Stamp::default(),
        pose: filter.robot().pose,
        covariance: Matrix3::zeros(),
        dead_reckoning: Pose2::identity(),
        n_landmarks: 0,
        nis: (0.0, 0),
        step: Duration::ZERO,
    };
    batch.estimated(filter, &estimate);
    batch.finish().expect("a minimum").estimates.kept()[0].pose
}

/// Small residuals leave the problem linear, and the kernel without effect: filter and batch are then the same estimator. The robot looks along y, so that
/// the axes of the map are not its own.
#[test]
fn batch_of_a_linear_problem_is_the_filter() {
    let sigmas = Vector3::new(0.01, 0.05, 0.02);
    let pose = PoseSensor { covariance: Matrix3::from_diagonal(&sigmas.map(|sigma| sigma * sigma)) };
    let position =
        PositionSensor { antenna: Vector2::new(0.3, -0.1), covariance: Matrix2::new(4e-4, 1e-4, 1e-4, 1e-3) };
    let heading = HeadingSensor { variance: 4e-4 };
    let rest = motion(Pose2::new(0.2, 0.01, 0.1));
    let off = 1e-4;
    for kind in 0..3 {
        let (mut filter, mut batch) = start();
        predict(&mut filter, &mut batch, &motion(Pose2::new(0.5, 0.05, 0.2)));
        let predicted = filter.robot().pose;
        let seen = predicted.compose(&rest.motion).retract(&Vector3::new(off, -off, off));
        let measurement = match kind {
            0 => MapMeasurement::Pose(pose, seen),
            1 => MapMeasurement::Position(position, seen.transform(&position.antenna)),
            _ => MapMeasurement::Heading(heading, Angle::new(seen.heading())),
        };
        measure(&mut filter, &mut batch, measurement, &rest);
        let correction = predicted.local(&filter.robot().pose);
        let of_batch = predicted.local(&solved(&filter, &mut batch));
        assert!(correction.norm() > 0.1 * off, "{kind}: {correction}");
        assert_abs_diff_eq!(of_batch, correction, epsilon = 2e-3 * off);
    }
}

/// A match of scans measures the drift, and a wall that is known with a covariance is seen: both are as the filter has them.
#[test]
fn batch_of_measured_drift_and_given_wall_is_the_filter() {
    let (mut filter, _) = start();
    let wall = Wall::between(WallLine::new(4.0, 0.0), [Vector2::new(4.0, 0.0), Vector2::new(4.0, 5.0)]);
    let id = LandmarkId(7);
    filter.insert(id, wall, Matrix2::new(4e-4, 0.0, 0.0, 1e-4)).expect("a wall");
    let mut batch = WallBatch::new(&filter);

    let before = filter.robot_covariance().m44;
    let measured = DRIFT + 1e-4;
    filter.update_robot(&HeadingDriftSensor(4e-5), &Vector1::new(measured)).expect("a drift");
    batch.heading_drift_measured(measured, filter.robot_covariance().m44.recip() - before.recip());
    let motion = moved(filter.robot().heading_drift, Pose2::new(0.5, 0.05, 0.2));
    predict(&mut filter, &mut batch, &motion);

    let predicted = filter.robot().pose;
    let expected = filter.model().expected(filter.robot(), &wall);
    let line = WallLine::new(expected.line.rho + 1e-4, expected.line.alpha - 1e-4);
    let seen = [Observation { label: Some(id), measurement: WallMeasurement { line, ..expected } }];
    let report = filter.update(&seen, &mut KnownIdAssociation).expect("a wall");
    assert!(matches!(report.outcomes[0], ObservationOutcome::Accepted { .. }), "{:?}", report.outcomes);
    batch.updated(&filter, &seen, &report);

    let correction = predicted.local(&filter.robot().pose);
    let of_batch = predicted.local(&solved(&filter, &mut batch));
    assert!(correction.norm() > 1e-5, "{correction}");
    assert_abs_diff_eq!(of_batch, correction, epsilon = 2e-7);
}

/// What becomes of the sightings and the prior of a wall when it is merged, restarted or fixed.
#[test]
fn sightings_follow_the_walls_of_the_filter() {
    let (mut filter, _) = start();
    let wall = Wall::between(WallLine::new(4.0, 0.0), [Vector2::new(4.0, 0.0), Vector2::new(4.0, 5.0)]);
    let [kept, removed] = [LandmarkId(1), LandmarkId(2)];
    for id in [kept, removed] {
        filter.insert(id, wall, Matrix2::identity() * 1e-4).expect("a wall");
    }
    let mut batch = WallBatch::new(&filter);
    let measurement = filter.model().expected(filter.robot(), &wall);
    let seen = [kept, removed].map(|id| Observation { label: Some(id), measurement });
    let report = filter.update(&seen, &mut KnownIdAssociation).expect("two walls");
    batch.updated(&filter, &seen, &report);
    let counts = |batch: &WallBatch| {
        let problem = batch.0.as_ref().expect("a problem");
        let of_kept = (problem.seen.get(&kept).map(Vec::len), problem.given.get(&kept).map(Vec::len));
        (of_kept, problem.seen.contains_key(&removed) || problem.given.contains_key(&removed))
    };
    assert_eq!(counts(&batch), ((Some(1), Some(1)), true));

    filter.remove(removed);
    let merged = UpdateReport { outcomes: Vec::new(), merges: vec![LandmarkMerge { kept, removed }] };
    batch.updated(&filter, &[], &merged);
    assert_eq!(counts(&batch), ((Some(2), Some(2)), false));

    let restarted = ObservationOutcome::Restarted { landmark: kept };
    let restarted = UpdateReport { outcomes: vec![restarted], merges: Vec::new() };
    batch.updated(&filter, &seen[..1], &restarted);
    assert_eq!(counts(&batch), ((Some(1), None), false));

    assert!(filter.fix(kept));
    batch.updated(&filter, &[], &UpdateReport { outcomes: Vec::new(), merges: Vec::new() });
    assert_eq!(counts(&batch), ((None, None), false));
}

#[test]
fn a_gross_outlier_moves_the_batch_little() {
    let anchor = Wall::between(WallLine::new(4.0, 0.0), [Vector2::new(4.0, 0.0), Vector2::new(4.0, 5.0)]);
    let solve = |outlier: f64| {
        let (mut filter, _) = start();
        filter.add_anchor(LandmarkId(7), anchor).expect("an anchor");
        let mut batch = WallBatch::new(&filter);
        let seen = filter.model().expected(filter.robot(), &anchor);
        let measurement =
            WallMeasurement { line: WallLine::new(seen.line.rho + outlier, seen.line.alpha), ..seen };
        batch.0.as_mut().expect("a problem").seen.insert(LandmarkId(7), vec![(0, measurement)]);
        let start = filter.robot().pose;
        start.local(&solved(&filter, &mut batch)).norm()
    };
    let (none, some, gross) = (solve(0.0), solve(0.1), solve(2.0));
    assert!(none < 1e-6 && some > 1e-3, "{none}, {some}");
    assert!(gross < some, "{gross}, {some}");
}

#[test]
fn a_run_that_is_too_long_frees_its_batch_and_says_so() {
    let (mut filter, mut batch) = start();
    let step = motion(Pose2::new(1e-3, 0.0, 0.0));
    for _ in 0..MAX_BATCH_POSES {
        predict(&mut filter, &mut batch, &step);
    }
    assert!(batch.0.is_some());
    predict(&mut filter, &mut batch, &step);
    assert!(batch.0.is_none());
    assert!(batch.finish().expect_err("no batch").contains("20000 keyframes"));

    let (filter, mut batch) = start();
    let measurement = MapMeasurement::Heading(HeadingSensor { variance: 1.0 }, Angle::new(0.0));
    for _ in 0..=MAX_BATCH_POSES {
        batch.measured(&filter, &measurement, Pose2::identity());
    }
    assert!(batch.0.is_none());
}
