//! Odometry that lags the panoramas.
#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::path::PathBuf;

use wayfix_sensor_log::{LogFormat, RecordData, Stamp};

use crate::common::Scratch;

use super::cml_drive::{Drive, log_run};

/// The log with odometry that comes `seconds` later than what the camera shows.
fn with_late_odometry(drive: &Drive, scratch: &Scratch, seconds: f64) -> PathBuf {
    let mut records = drive.records();
    for record in records.iter_mut().filter(|record| matches!(record.data, RecordData::OdometryIncrement(_)))
    {
        record.stamp = Stamp::from_nanoseconds(record.stamp.nanoseconds() + (seconds * 1e9) as u64);
    }
    records.sort_by_key(|record| record.stamp);
    let path = scratch.path("late.mcap");
    wayfix_sensor_log::write(&path, LogFormat::Mcap, records).unwrap();
    path
}

/// Turns of panoramas and of odometry agree best one image later; with the delay that is said the run is that of the log without it.
#[test]
fn lag_of_odometry_behind_panoramas_is_said() {
    let (scratch, drive) = (Scratch::new(), Drive::new());
    let right = log_run(&drive.log(&scratch), &[]);
    assert_eq!(right.event("odometry_lags"), 0, "{}", right.stderr);
    let log = with_late_odometry(&drive, &scratch, 0.5);
    let late = log_run(&log, &[]);
    assert_eq!(late.event("odometry_lags"), 1, "{}", late.stderr);
    assert!(late.stderr.contains("`odometry_delay = 0.50`"), "{}", late.stderr);
    let params = scratch.file("delay.toml", "odometry_delay = 0.5");
    let corrected = log_run(&log, &["--params", params.to_str().unwrap()]);
    assert_eq!(corrected.figures(), right.figures());
}
