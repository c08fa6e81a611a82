//! External sensors and anchors in the filters of points and of walls.

use nalgebra::{Matrix3, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{
    Detection, DetectionTarget, LogOpenOptions, MeasuredQuantity, PoseMeasurement, Record, RecordData, Stamp,
    Velocity, open,
};
use wayfix_slam_ekf::{AnchorParams, ExternalParams};
use wayfix_slam_system::points::{self, PointRun, PointSlamParams, RobotProfile, SavedPointMap};
use wayfix_slam_system::walls::{self, WallSlamParams};

fn at(seconds: f64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_seconds(seconds).expect("a time"), data }
}

fn measured(seconds: f64, frame: &str, quantity: MeasuredQuantity, sigma: Option<f64>) -> Record {
    let covariance = sigma.map(|sigma| Matrix3::identity() * sigma * sigma);
    at(
        seconds,
        RecordData::PoseMeasurement(PoseMeasurement { frame: frame.to_owned(), quantity, covariance }),
    )
}

fn position(x: f64, y: f64) -> MeasuredQuantity {
    MeasuredQuantity::Position(Vector2::new(x, y))
}

/// A robot that drives ahead at 1 m/s for 20 s, by its odometry at 0.98 m/s, and sees a landmark in the first two seconds.
fn drive(heading: f64) -> Vec<Record> {
    let start = Pose2::new(0.0, 0.0, heading);
    let mut records = vec![at(0.0, RecordData::TruePose(start))];
    let landmark = Vector2::new(8.0, 3.0);
    for step in 0..200 {
        let seconds = 0.1 * f64::from(step);
        records.push(at(seconds, RecordData::Velocity(Velocity { linear: 0.98, angular: 0.0 })));
        let truth = start.compose(&Pose2::new(seconds, 0.0, 0.0));
        let seen = truth.inverse_transform(&start.transform(&landmark));
        let (range, bearing) = (seen.norm(), seen.y.atan2(seen.x));
        let target = DetectionTarget::Landmark(7);
        let seen = if seconds < 2.0 { vec![Detection { target, range, bearing }] } else { Vec::new() };
        records.push(at(seconds, RecordData::Detections(seen)));
    }
    records
}

fn with(mut records: Vec<Record>, more: impl IntoIterator<Item = Record>) -> Vec<Record> {
    records.extend(more);
    records.sort_by_key(|record| record.stamp);
    records
}

fn slam(records: &[Record], external: ExternalParams) -> PointRun {
    let params = PointSlamParams { external, ..PointSlamParams::of(RobotProfile::Generic) };
    points::run(records, &params, |_| {}).expect("a usable log")
}

fn in_map() -> ExternalParams {
    ExternalParams { map_frame_ids: vec!["map".to_owned()], ..ExternalParams::default() }
}

#[test]
fn positions_correct_points_only_where_they_are_asked_for() {
    let fixes = (1..20).map(|s| measured(f64::from(s), "map", position(f64::from(s), 0.0), Some(0.05)));
    let records = with(drive(0.0), fixes);
    let error = |run: &PointRun| (run.system.filter().robot().pose.x() - 19.9).abs();
    let mut without = slam(&records, ExternalParams::default());
    assert_eq!(without.events().get("measurement_ignored"), 19);
    let mut with = slam(&records, in_map());
    assert_eq!(with.events().get("measurement_accepted"), 19);
    assert!(error(&with) < 0.5 * error(&without), "{} {}", error(&with), error(&without));
}

#[test]
fn useless_measurements_are_counted_and_change_nothing() {
    let clean = slam(&drive(0.5), in_map());
    let heading = MeasuredQuantity::Heading(-0.5);
    let geodetic = MeasuredQuantity::Geodetic { latitude: 48.0, longitude: 11.0 };
    let singular = |seconds| {
        let covariance = Some(Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0)));
        let frame = "map".to_owned();
        let quantity = position(0.0, 0.0);
        at(seconds, RecordData::PoseMeasurement(PoseMeasurement { frame, quantity, covariance }))
    };
    for (record, event) in [
        (measured(5.05, "map", position(5.0, 0.0), None), "record_refused"),
        (measured(5.05, "odom", position(5.0, 0.0), Some(0.1)), "record_refused"),
        (measured(5.05, "wgs84", geodetic, Some(0.1)), "record_refused"),
        (measured(5.05, "map", position(f64::NAN, 0.0), Some(0.1)), "record_refused"),
        (singular(5.05), "record_refused"),
        (measured(5.05, "map", position(105.0, 0.0), Some(0.1)), "measurement_gated"),
        (measured(5.05, "map", heading, Some(0.05)), "measurement_gated"),
    ] {
        let mut run = slam(&with(drive(0.5), [record.clone()]), in_map());
        assert_eq!(run.events().get(event), 1, "{record:?}");
        assert_eq!(run.events().n_refusals(), 1, "{record:?}");
        let (got, expected) = (run.system.filter(), clean.system.filter());
        let moved = (got.robot().pose.translation - expected.robot().pose.translation).norm();
        assert!(moved < 1e-9, "{record:?} moves the robot by {moved}");
        let difference = (got.covariance() - expected.covariance()).amax();
        // The motion is cut at the stamp; a correction would take some 1e-4 m² off.
        assert!(difference < 1e-6, "{record:?} changes the covariance by {difference}");
    }
}

#[test]
fn wgs_84_needs_a_datum_and_then_is_east_and_north() {
    let fix = |second: i32| {
        let degrees = f64::from(second) / 111_319.5; // a degree of longitude on the equator
        let fix = MeasuredQuantity::Geodetic { latitude: 0.0, longitude: 20.0 + degrees };
        measured(f64::from(second), "wgs84", fix, Some(0.05))
    };
    let records = with(drive(0.0), (1..20).map(fix));
    let external = ExternalParams { datum: Some([0.0, 20.0]), ..ExternalParams::default() };
    let mut run = slam(&records, external);
    assert_eq!(run.events().get("measurement_accepted"), 19);
    let robot = run.system.filter().robot().pose;
    assert!((robot.translation - Vector2::new(19.9, 0.0)).norm() < 0.4, "{robot:?}");
}

#[test]
fn unknown_anchor_of_points_is_an_error_with_numbers() {
    let anchor = |id, covariance| AnchorParams { id, at: [8.0, 3.0], covariance };
    let run = |anchor| {
        let params = PointSlamParams { anchors: vec![anchor], ..PointSlamParams::of(RobotProfile::Generic) };
        points::run(&drive(0.0), &params, |_| {})
    };
    assert!(run(anchor(7, None)).expect("a usable log").system.filter().anchors().count() == 1);
    let unknown = run(anchor(8, None)).err().expect("landmark 8 is never seen").to_string();
    assert_eq!(unknown, "anchor 8: the log has no detection of landmark 8, but of 1 others");
    let singular = run(anchor(7, Some([[1.0, 1.0], [1.0, 1.0]]))).err().expect("singular").to_string();
    assert!(singular.starts_with("anchor 7: landmark covariance is not a covariance"), "{singular}");
}

#[test]
fn positions_and_anchors_correct_walls() {
    let office = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/office_laser.mcap");
    let (records, _) = open(office, &LogOpenOptions::default()).expect("a stored log").read_all();
    let end = records.first().expect("records").stamp.seconds() + 60.0;
    let records: Vec<Record> = records.into_iter().filter(|record| record.stamp.seconds() < end).collect();
    let mut last = 0.0;
    let mut fixes = Vec::new();
    for record in &records {
        let seconds = record.stamp.seconds();
        if let RecordData::TruePose(pose) = &record.data
            && seconds >= last + 5.0
        {
            last = seconds;
            let far = if fixes.len() == 3 { 100.0 } else { 0.0 };
            fixes.push(measured(seconds, "map", position(pose.x() + far, pose.y()), Some(0.1)));
        }
    }
    let n_fixes = fixes.len() as u64;
    let records = with(records, fixes);
    let params = WallSlamParams { external: in_map(), match_scans: false, ..WallSlamParams::default() };
    let mut run = walls::run(&records, &params, |_| {}).expect("a usable log");
    assert_eq!(run.events().get("measurement_gated"), 1, "the jump of 100 m");
    assert!(run.events().get("measurement_accepted") + 3 >= n_fixes, "{n_fixes}");
    let summary = walls::summarize(&mut run);
    let figure = |name: &str| summary.metrics.iter().find(|metric| metric.name == name).expect(name).value;
    assert!(figure("batch_ate_rmse_m") < figure("ate_rmse_m")); // the batch has all fixes for every pose

    let mut params = WallSlamParams { expected_walls: true, ..WallSlamParams::default() };
    params.filter.anchor_first = 1;
    let mut run = walls::run(&records, &params, |_| {}).expect("a usable log");
    assert_eq!(run.system.filter().anchors().count(), 1);
    let [expected, found] = ["wall_expected", "wall_in_search_band"].map(|event| run.events().get(event));
    assert!(found > 0 && found <= expected, "{found} of {expected}");

    let far = AnchorParams { id: 70, at: [[900.0, 0.0], [900.0, 5.0]], covariance: None };
    params.anchors = vec![far];
    let mut run = walls::run(&records, &params, |_| {}).expect("a usable log");
    assert_eq!(run.events().get("anchor_never_seen"), 1);
    assert!(run.events().warnings().iter().any(|warning| warning.text.contains("anchor 70 was never seen")));

    params.anchors = vec![AnchorParams { id: 1, at: [[0.0, 0.0]; 2], covariance: None }];
    let nowhere = walls::run(&records, &params, |_| {}).err().expect("a wall of no length").to_string();
    assert!(nowhere.starts_with("anchor 1: landmark is not finite"), "{nowhere}");
}

/// The robot drives circles of 5 m by increments of 1 Hz; a compass reads between them.
fn circle(sign: f64, n_readings: usize) -> Vec<Record> {
    let per_second = Pose2::exp(&Vector3::new(1.0, 0.0, 0.2));
    let mut records = vec![at(0.0, RecordData::TruePose(Pose2::identity()))];
    let mut truth = Pose2::identity();
    for second in 1..=60 {
        truth = truth.compose(&per_second);
        records.push(at(f64::from(second), RecordData::OdometryIncrement(per_second)));
        let seen = truth.inverse_transform(&Vector2::new(1.0, 5.0));
        let (range, bearing) = (seen.norm(), seen.y.atan2(seen.x));
        let seen = Detection { target: DetectionTarget::Landmark(7), range, bearing };
        records.push(at(f64::from(second), RecordData::Detections(vec![seen])));
    }
    let reading = |second: usize| {
        let seconds = second as f64 + 0.5;
        measured(seconds, "map", MeasuredQuantity::Heading(sign * 0.2 * seconds), Some(0.05))
    };
    with(records, (0..n_readings).map(reading))
}

#[test]
fn mirrored_compass_is_not_used_and_is_said() {
    let mut right = slam(&circle(1.0, 60), in_map());
    // Two readings near the axis of the mirror leave the sign open.
    assert!(right.events().get("measurement_withheld") <= 2);
    assert!(right.events().get("measurement_accepted") >= 58);
    assert_eq!(right.events().get("compass_mirrored"), 0);

    let mut mirrored = slam(&circle(-1.0, 60), in_map());
    let [withheld, gated] =
        ["measurement_withheld", "measurement_gated"].map(|event| mirrored.events().get(event));
    assert!(gated >= 58 && withheld + gated == 60, "{gated} refused, {withheld} withheld");
    assert_eq!(mirrored.events().get("compass_mirrored"), 1);
    let without = slam(&circle(-1.0, 0), in_map());
    assert_eq!(mirrored.system.filter().robot(), without.system.filter().robot());
}

#[test]
fn waiting_measurements_are_saved_and_resumed() {
    let records = circle(1.0, 60);
    let params = PointSlamParams { external: in_map(), ..PointSlamParams::of(RobotProfile::Generic) };
    let mut halves = Vec::new();
    let whole = points::run(&records, &params, |step| {
        if let RecordData::PoseMeasurement(_) = step.record.data {
            halves.push(step.system.save());
        }
    })
    .expect("a usable log");
    assert!(halves.iter().skip(1).all(|half| half.external.waiting.len() == 1));
    for half in halves {
        let bytes = half.to_bytes().expect("a state");
        let half = SavedPointMap::from_bytes(&bytes).expect("the same state");
        let resumed = points::run_on(half, &records, &records, &params, |_| {}).expect("a usable log");
        assert_eq!(resumed.system.save(), whole.system.save());
    }
}
