//! Detections that contradict odometry.

use wayfix_estimation_traits::LieGroup;
use wayfix_sensor_log::{LogOpenOptions, Record, RecordData, open};
use wayfix_slam_system::points::{self, PointSlamParams, RobotProfile};

fn log() -> Vec<Record> {
    let path = format!("{}/../../fixtures/loop_known.mcap", env!("CARGO_MANIFEST_DIR"));
    open(&path, &LogOpenOptions::default()).expect("a stored log").read_all().0
}

/// Whether a run says that observations contradict odometry.
fn is_said(records: &[Record]) -> bool {
    let params = PointSlamParams::of(RobotProfile::Generic);
    let mut run = points::run(records, &params, |_| {}).expect("a usable log");
    run.events().get("observations_contradict_odometry") == 1
}

#[test]
fn bearings_and_turns_of_the_wrong_sign_are_said() {
    let records = log();
    assert!(!is_said(&records));
    let (mut bearings, mut turns) = (records.clone(), records);
    for record in &mut bearings {
        if let RecordData::Detections(detections) = &mut record.data {
            detections.iter_mut().for_each(|detection| detection.bearing = -detection.bearing);
        }
    }
    for record in &mut turns {
        match &mut record.data {
            RecordData::OdometryIncrement(increment) => *increment = increment.inverse(),
            RecordData::Velocity(velocity) => velocity.angular = -velocity.angular,
            _ => {}
        }
    }
    assert!(is_said(&bearings) && is_said(&turns));
}

#[test]
fn odometry_that_ends_early_is_said() {
    let records = log();
    let middle = records[records.len() / 2].stamp;
    let is_kept = |record: &&Record| {
        record.stamp < middle
            || !matches!(record.data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_))
    };
    let ended: Vec<Record> = records.iter().filter(is_kept).cloned().collect();
    let params = PointSlamParams::of(RobotProfile::Generic);
    let n_said = |records: &[Record]| {
        let mut run = points::run(records, &params, |_| {}).expect("a usable log");
        run.events().get("odometry_ends_early")
    };
    assert_eq!([n_said(&ended), n_said(&records)], [1, 0]);
}
