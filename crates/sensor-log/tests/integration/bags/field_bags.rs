//! Bags from the field: one bad transform, stamp, limit or part is lost alone, and what is assumed is said.

#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::fs;
use std::path::Path;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{
    LogError, LogFormat, LogOpenOptions, ReadReport, Record, RecordData, RowProblemKind, open,
};

use crate::common::bag::{Bag, ODOMETRY, SCAN, TRANSFORMS, odometry, scan, transforms};
use crate::common::cdr::Encoder;

const SECOND: u64 = 1_000_000_000;
const MOUNT: [f64; 3] = [0.2, 0.1, 0.0];

/// A transform: seconds, parent, child, translation along x and quaternion.
type Raw<'a> = (i32, &'a str, &'a str, f64, [f64; 4]);
const UNIT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
const GOOD: Raw<'_> = (1, "base_link", "laser", 0.2, UNIT);

fn raw_transforms(all: &[Raw<'_>]) -> Encoder {
    let mut cdr = Encoder::new(true);
    cdr.u32(all.len() as u32);
    for (seconds, parent, child, x, rotation) in all {
        cdr.header(*seconds, 0, parent);
        cdr.string(child);
        cdr.f64s(&[*x, 0.1, 0.5]);
        cdr.f64s(rotation);
    }
    cdr
}

fn limited_scan(seconds: i32, frame: &str, [range_min, range_max]: [f32; 2]) -> Encoder {
    let mut cdr = crate::common::bag::at(seconds, frame);
    [-0.5, 0.5, 0.25, 0.0, 0.1, range_min, range_max].iter().for_each(|number| cdr.f32(*number));
    cdr.f32s(&[1.0, 2.0, 3.0]);
    cdr.f32s(&[]);
    cdr
}

/// One scan each second of a laser that `/tf_static` places.
fn stretch(seconds: std::ops::Range<i32>) -> Bag {
    let mut bag = Bag::new();
    for step in seconds {
        let log_time = step as u64 * SECOND;
        bag.put("/tf_static", TRANSFORMS, log_time, transforms(&[(step, "base_link", "laser", MOUNT)]));
        bag.put("/scan", SCAN, log_time, scan(step, &[1.0, 2.0]));
    }
    bag
}

fn put_file(folder: &Path, name: &str, bytes: &[u8]) {
    fs::write(folder.join(name), bytes).unwrap();
}

fn read_folder(folder: &Path) -> (Vec<Record>, ReadReport) {
    open(folder, &LogOpenOptions::default()).unwrap().read_all()
}

fn scan_seconds(records: &[Record]) -> Vec<u64> {
    let is_scan = |record: &&Record| matches!(record.data, RecordData::Scan(_));
    records.iter().filter(is_scan).map(|record| record.stamp.nanoseconds() / SECOND).collect()
}

fn mounts(records: &[Record]) -> Vec<Pose2<f64>> {
    let mount = |record: &Record| match &record.data {
        RecordData::LaserMount(mount) => Some(*mount),
        _ => None,
    };
    records.iter().filter_map(mount).collect()
}

fn warning<'a>(report: &'a ReadReport, name: &str) -> Option<&'a str> {
    report.warnings.iter().find(|warning| warning.name == name).map(|warning| warning.text.as_str())
}

#[test]
fn bad_transform_is_ignored_alone_wherever_it_is() {
    let bad: [Raw<'_>; 8] = [
        (1, "base_link", "arm", f64::NAN, UNIT),
        (1, "base_link", "arm", f64::INFINITY, UNIT),
        (1, "base_link", "arm", 1.0, [0.5, 0.0, 0.0, 0.0]),
        (1, "base_link", "arm", 1.0, [f64::NAN; 4]),
        (1, "base_link", "base_link", 1.0, UNIT),
        (1, "", "arm", 1.0, UNIT),
        (1, "base_link", "", 1.0, UNIT),
        (1, "base_link", "laser", f64::NAN, UNIT),
    ];
    let other = (1, "base_link", "imu", 0.3, UNIT);
    for bad in bad {
        for topic in ["/tf", "/tf_static"] {
            for order in [[bad, GOOD, other], [other, bad, GOOD], [GOOD, other, bad]] {
                let mut bag = Bag::new();
                bag.put(topic, TRANSFORMS, SECOND, raw_transforms(&order));
                bag.put("/scan", SCAN, 2 * SECOND, scan(2, &[1.0]));
                let (records, report) = bag.read();
                assert_eq!(mounts(&records), [Pose2::new(0.2, 0.1, 0.0)], "{order:?}");
                assert_eq!(report.n_problems(), 1, "{order:?}: {report:?}");
                assert_eq!(warning(&report, "laser_mount_unknown"), None);
            }
        }
    }
}

#[test]
fn stamp_of_a_static_transform_does_not_matter() {
    for seconds in [-5, 0, i32::MAX] {
        let mut bag = Bag::new();
        let first = (seconds, "base_link", "imu", 0.3, UNIT);
        let laser = (seconds, "base_link", "laser", 0.2, UNIT);
        bag.put("/tf_static", TRANSFORMS, SECOND, raw_transforms(&[first, laser]));
        bag.put("/scan", SCAN, 2 * SECOND, scan(2, &[1.0]));
        let (records, report) = bag.read();
        assert_eq!(mounts(&records), [Pose2::new(0.2, 0.1, 0.0)], "{seconds}");
        assert_eq!(scan_seconds(&records), [2]);
        assert!(report.is_clean(), "{report:?}");
    }
}

#[test]
fn unknown_laser_mount_is_said_with_frame_and_parameter() {
    let unconnected = [(1, "base_link", "other_laser", MOUNT), (1, "mast", "laser", MOUNT)];
    for frames in [&unconnected[..0], &unconnected[..1], &unconnected[1..]] {
        let mut bag = Bag::new();
        bag.put("/tf_static", TRANSFORMS, SECOND, transforms(frames));
        bag.put("/scan", SCAN, 2 * SECOND, scan(2, &[1.0]));
        let (records, report) = bag.read();
        assert_eq!((mounts(&records).len(), scan_seconds(&records).len()), (0, 1));
        let text = warning(&report, "laser_mount_unknown").unwrap();
        assert!(text.contains("\"laser\"") && text.contains("laser = [x, y, heading]"), "{text}");
    }
}

#[test]
fn laser_in_the_frame_of_the_robot_needs_no_transform() {
    for frame in ["base_link", "base_footprint", "/base_link", "robot1/base_link"] {
        let mut bag = Bag::new();
        bag.put("/odom", ODOMETRY, SECOND, odometry(1, [0.0; 3], 0.0));
        bag.put("/scan", SCAN, 2 * SECOND, limited_scan(2, frame, [0.1, 10.0]));
        let (_, report) = bag.read();
        assert!(report.is_clean(), "{frame}: {report:?}");
    }
}

#[test]
fn moving_laser_has_its_mount_before_each_scan_and_is_said() {
    let mut bag = Bag::new();
    for step in 1..4 {
        let log_time = step as u64 * SECOND;
        let mount = [0.2, 0.0, 0.5 * f64::from(step)];
        bag.put("/tf", TRANSFORMS, log_time, transforms(&[(step, "base_link", "laser", mount)]));
        bag.put("/scan", SCAN, log_time, scan(step, &[1.0]));
    }
    let (records, report) = bag.read();
    let headings: Vec<f64> = mounts(&records).iter().map(Pose2::heading).collect();
    assert_eq!(headings.len(), 3);
    assert!(headings.iter().zip([0.5, 1.0, 1.5]).all(|(is, should)| (is - should).abs() < 1e-12));
    let text = warning(&report, "laser_mount_moves").unwrap();
    assert!(text.contains("2 times"), "{text}");
}

#[test]
fn clock_set_back_cuts_the_log_and_counts_the_rest() {
    let mut bag = stretch(1000..1040);
    for step in 0..40_i32 {
        let log_time = (1040 + step) as u64 * SECOND;
        bag.put("/scan", SCAN, log_time, scan(500 + step, &[1.0]));
    }
    let (records, report) = bag.read();
    assert_eq!(scan_seconds(&records), (1000..1040).collect::<Vec<_>>());
    let text = warning(&report, "clock_set_back").unwrap();
    assert!(text.contains("/scan"), "{text}");
    // Each message of the second stretch is a problem or is counted in the warning.
    let n_counted = text.split_whitespace().find_map(|word| word.parse::<u64>().ok()).unwrap();
    assert_eq!(n_counted + report.n_problems(), 40, "{text} {report:?}");
}

#[test]
fn single_wrong_stamp_of_a_scan_is_lost_alone() {
    for wrong in [1, -5, i32::MAX] {
        let mut bag = stretch(1000..1020);
        bag.put("/scan", SCAN, 1020 * SECOND, scan(wrong, &[1.0]));
        for step in 1021..1040 {
            bag.put("/scan", SCAN, step as u64 * SECOND, scan(step, &[1.0]));
        }
        let (records, report) = bag.read();
        let right: Vec<u64> = (1000..1040).filter(|second| *second != 1020).collect();
        assert_eq!(scan_seconds(&records), right, "{wrong}");
        assert_eq!((report.n_problems(), warning(&report, "clock_set_back")), (1, None), "{wrong}");
    }
}

#[test]
fn absurd_log_time_in_a_part_loses_no_other_message() {
    for at in [0, 5, 9] {
        let folder = tempfile::tempdir().unwrap();
        put_file(folder.path(), "drive_0.mcap", &stretch(1000..1010).finish());
        let mut second = Bag::new();
        for step in 0..10_i32 {
            let log_time = if step == at { u64::MAX } else { (1010 + step) as u64 * SECOND };
            second.put("/scan", SCAN, log_time, scan(1010 + step, &[1.0]));
        }
        put_file(folder.path(), "drive_1.mcap", &second.finish());
        put_file(folder.path(), "drive_2.mcap", &stretch(1020..1030).finish());
        let (records, report) = read_folder(folder.path());
        let seconds = scan_seconds(&records);
        let others = (1000..1030).filter(|second| *second != 1010 + at as u64);
        assert!(others.clone().all(|second| seconds.contains(&second)), "{at}: {seconds:?} {report:?}");
        assert!(seconds.is_sorted());
    }
}

#[test]
fn empty_or_broken_part_is_named_and_the_rest_is_read() {
    for broken in 0..3 {
        for bytes in [&b""[..], &b"\x89MC"[..], &b"no bag at all, only text"[..]] {
            let folder = tempfile::tempdir().unwrap();
            let mut right = Vec::new();
            for part in 0..3_i32 {
                let seconds = 1000 + 10 * part..1010 + 10 * part;
                let name = format!("drive_{part}.mcap");
                if part == broken {
                    put_file(folder.path(), &name, bytes);
                } else {
                    right.extend(seconds.clone().map(|second| second as u64));
                    put_file(folder.path(), &name, &stretch(seconds).finish());
                }
            }
            let (records, report) = read_folder(folder.path());
            assert_eq!(scan_seconds(&records), right, "{broken} {bytes:?}");
            assert_eq!(report.problems.get(&RowProblemKind::UnreadableFile), Some(&1));
            assert_eq!(report.examples[0].file, format!("drive_{broken}.mcap"));
        }
    }
}

#[test]
fn unusable_range_limit_is_no_limit_and_is_said_once() {
    let limits = [
        [0.1, 0.0],
        [0.1, f32::INFINITY],
        [0.1, f32::NAN],
        [0.1, -1.0],
        [30.0, 10.0],
        [f32::INFINITY, 10.0],
        [f32::NAN, 0.0],
        [0.0, f32::MAX],
    ];
    for limits in limits {
        let mut bag = stretch(1..2);
        for step in 2..5 {
            bag.put("/scan", SCAN, step as u64 * SECOND, limited_scan(step, "laser", limits));
        }
        let (records, report) = bag.read();
        assert_eq!(scan_seconds(&records), [1, 2, 3, 4], "{limits:?}");
        let RecordData::Scan(last) = &records.last().unwrap().data else {
            unreachable!("the scan comes last")
        };
        assert_eq!(last.echoes().count(), 3, "{limits:?}");
        let n_said = report.warnings.iter().filter(|warning| warning.name == "range_limit_unknown").count();
        assert_eq!(n_said, usize::from(limits[1] != f32::MAX), "{limits:?}");
        assert!(report.warnings.iter().all(|warning| warning.text.len() < 250));
    }
}

#[test]
fn parts_that_the_metadata_does_not_name_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for part in 0..3_i32 {
        let bytes = stretch(10 * part + 1..10 * part + 11).finish();
        put_file(folder.path(), &format!("drive_{part}.mcap"), &bytes);
    }
    let metadata = "  relative_file_paths:\n    - drive_0.mcap\n    - drive_7.mcap\n";
    put_file(folder.path(), "metadata.yaml", metadata.as_bytes());
    for hidden in ["._drive_0.mcap", ".DS_Store", "Thumbs.db", "desktop.ini"] {
        put_file(folder.path(), hidden, b"\0\x05\x16\x07 no bag");
    }
    let (records, report) = read_folder(folder.path());
    assert_eq!(scan_seconds(&records), (1..31).collect::<Vec<_>>());
    assert_eq!(report.n_problems(), 0, "{report:?}");
    assert!(warning(&report, "metadata_is_stale").unwrap().contains("1 of the 3"));
    assert!(warning(&report, "bag_part_missing").unwrap().contains("drive_7.mcap"));
}

#[test]
fn missing_first_part_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for part in 1..3_i32 {
        let mut bag = Bag::new();
        for step in 10 * part..10 * part + 10 {
            bag.put("/scan", SCAN, step as u64 * SECOND, scan(step, &[1.0]));
        }
        put_file(folder.path(), &format!("drive_{part}.mcap"), &bag.finish());
    }
    let (records, report) = read_folder(folder.path());
    assert_eq!(scan_seconds(&records).len(), 20);
    assert!(warning(&report, "bag_part_missing").unwrap().contains("part 0"));
    assert!(warning(&report, "laser_mount_unknown").is_some());
}

#[test]
fn message_about_a_wrong_format_reads_well_for_all() {
    let formats = [
        LogFormat::Utias,
        LogFormat::VictoriaPark,
        LogFormat::RangeBearing,
        LogFormat::Tum,
        LogFormat::Carmen,
        LogFormat::ScanJson,
        LogFormat::Mcap,
        LogFormat::Images,
    ];
    for format in formats {
        let error = LogError::NotThisFormat { path: "x".into(), format, reason: "it is empty".into() };
        let text = error.to_string();
        assert!(!text.contains(" a i") && !text.contains(" a u"), "{text}");
        assert!(text.contains(&format.to_string()), "{text}");
    }
}
