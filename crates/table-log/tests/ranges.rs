//! Tables of ranges: what is read, and what is said about the rest.

#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::assert_abs_diff_eq;
use std::{fs, path::Path};

use wayfix_sensor_log::{RecordData, RowProblemKind};
use wayfix_table_log::RangeRecording;

const ODOMETRY: &str = "t_s,distance_m,turn_rad\n1.0,0.5,0.1\n1.2,0.5,-0.1\n1.4,0.5,0.0\n";
const RANGES: &str = "t_s,beacon,range_m\n1.1,3,10.5\n1.3,4,11.5\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn error(path: &Path) -> String {
    let error = RangeRecording::read(path).unwrap_err();
    let source = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
    format!("{error} {source}")
}

#[test]
fn tables_are_read_and_truth_is_optional() {
    let plain = folder(&[("odometry.csv", ODOMETRY), ("ranges.csv", RANGES)]);
    assert!(RangeRecording::is_in(plain.path()));
    let read = RangeRecording::read(plain.path()).unwrap();
    assert!(read.report.is_clean() && read.truth.is_empty());
    assert_eq!((read.odometry.len(), read.ranges.len()), (3, 2));
    assert_eq!((read.ranges[1].beacon, read.ranges[1].range), (4, 11.5));
    assert_abs_diff_eq!(read.odometry[0].1.heading(), 0.1, epsilon = 1e-12);
    let whole = folder(&[
        ("odometry.csv", ODOMETRY),
        ("ranges.csv", RANGES),
        ("truth.csv", "t_s,x_m,y_m,heading_rad\n1.0,2,3,7.0\n"),
        ("beacons.csv", "beacon,x_m,y_m\n3,5,6\n"),
    ]);
    let truth = RangeRecording::read(whole.path()).unwrap().truth;
    assert!(matches!(truth[0].data, RecordData::TrueLandmark(beacon) if beacon.id == 3 && beacon.y == 6.0));
    let turned = 7.0 - std::f64::consts::TAU;
    assert!(matches!(truth[1].data, RecordData::TruePose(pose) if (pose.heading() - turned).abs() < 1e-9));
}

#[test]
fn late_and_broken_rows_are_counted() {
    let ranges =
        "t_s,beacon,range_m\n1.3,4,11.5\n1.1,3,10.5\n1.2,3,nan\n1.2,3\n1.2,1.5,9\n-1,3,9\n1.25,3,0\n";
    let folder = folder(&[("odometry.csv", ODOMETRY), ("ranges.csv", ranges)]);
    let read = RangeRecording::read(folder.path()).unwrap();
    let ranges: Vec<f64> = read.ranges.iter().map(|row| row.range).collect();
    assert_eq!(ranges, [10.5, 0.0, 11.5]);
    let count = |kind| read.report.problems.get(&kind).copied().unwrap_or(0);
    assert_eq!(count(RowProblemKind::NotANumber), 2);
    assert_eq!(count(RowProblemKind::ColumnCount), 1);
    assert_eq!(count(RowProblemKind::BadStamp), 1);
    assert_eq!(count(RowProblemKind::OutOfOrder), 1);
}

#[test]
fn missing_empty_and_other_tables_are_named() {
    let empty = folder(&[]);
    assert!(!RangeRecording::is_in(empty.path()));
    assert!(error(empty.path()).contains("odometry.csv"));
    assert!(error(folder(&[("odometry.csv", ODOMETRY)]).path()).contains("ranges.csv"));
    let other = folder(&[("odometry.csv", ODOMETRY), ("ranges.csv", "t_s,beacon,bearing_rad\n1,2,3\n")]);
    assert!(error(other.path()).contains("t_s,beacon,range_m"));
    let headless = folder(&[("odometry.csv", "1,2,3\n"), ("ranges.csv", RANGES)]);
    assert!(error(headless.path()).contains("t_s,distance_m,turn_rad"));
    let nothing = folder(&[("odometry.csv", ODOMETRY), ("ranges.csv", "t_s,beacon,range_m\n1,2,nan\n")]);
    assert!(error(nothing.path()).contains("no row of use"));
}
