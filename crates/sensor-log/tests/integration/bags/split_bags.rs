//! Logs in several files: a recorder split them, or several recorders ran.

#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::fs;
use std::path::{Path, PathBuf};

use wayfix_sensor_log::{
    LogCompleteness, LogError, LogFormat, LogOpenOptions, ReadReport, Record, RecordData, Stamp, Velocity,
    open, open_all, write,
};

use crate::common::bag::{Bag, ODOMETRY, POSE, SCAN, TRANSFORMS, odometry, pose, scan, transforms};

const STEPS: i32 = 40;
const SECOND: u64 = 1_000_000_000;

/// A robot that drives along x; the transform of its laser is said once, in the beginning. Topics of which `wants` holds.
fn put(bag: &mut Bag, steps: std::ops::Range<i32>, wants: impl Fn(&str) -> bool) {
    for step in steps {
        let log_time = step as u64 * SECOND;
        if step == 1 && wants("/tf_static") {
            let mount = transforms(&[(step, "base_link", "laser", [0.2, 0.0, 0.0])]);
            bag.put("/tf_static", TRANSFORMS, log_time, mount);
        }
        if wants("/odom") {
            bag.put("/odom", ODOMETRY, log_time, odometry(step, [f64::from(step), 0.1, 0.0], 0.0));
        }
        if wants("/scan") {
            bag.put("/scan", SCAN, log_time + SECOND / 2, scan(step, &[1.0, step as f32]));
        }
    }
}

fn bag(steps: std::ops::Range<i32>, wants: impl Fn(&str) -> bool) -> Vec<u8> {
    let mut bag = Bag::new();
    put(&mut bag, steps, wants);
    bag.finish()
}

fn whole() -> (Vec<Record>, ReadReport) {
    crate::common::bag::read(&bag(1..STEPS, |_| true), &[]).unwrap()
}

fn file(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn a_recording_that_was_split_reads_like_the_whole_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    // Ten parts and more, of which part_10 comes before part_2 by name.
    for part in 0..13 {
        let (from, to) = (1 + 3 * part, (4 + 3 * part).min(STEPS));
        file(folder.path(), &format!("part_{part}.mcap"), &bag(from..to, |_| true));
    }
    let log = open(folder.path(), &LogOpenOptions::default()).unwrap();
    assert_eq!((log.meta().source.as_path(), log.meta().files.len()), (folder.path(), 13));
    let scans = log.meta().topics.iter().find(|topic| topic.name == "/scan").unwrap().n_messages;
    assert_eq!(scans, STEPS as u64 - 1, "of all files together");
    let (records, report) = log.read_all();
    let expected = whole();
    assert_eq!(records, expected.0);
    assert_eq!(report, expected.1);
    assert!(report.is_clean(), "{report}");

    let mut files: Vec<PathBuf> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort_by_key(|path| std::cmp::Reverse(path.clone()));
    assert_eq!(open_all(&files, &LogOpenOptions::default()).unwrap().read_all(), expected);
}

#[test]
fn two_recorders_at_a_time_read_like_one() {
    let folder = tempfile::tempdir().unwrap();
    let laser = file(folder.path(), "laser.mcap", &bag(1..STEPS, |topic| topic == "/scan"));
    let rest = file(folder.path(), "base.mcap", &bag(1..STEPS, |topic| topic != "/scan"));
    for files in [[&laser, &rest], [&rest, &laser]] {
        let (records, report) = open_all(&files, &LogOpenOptions::default()).unwrap().read_all();
        assert_eq!(records, whole().0);
        assert!(report.is_clean(), "{report}");
    }
    let error = open(folder.path(), &LogOpenOptions::default()).unwrap_err();
    assert!(matches!(error, LogError::SeveralFiles { .. }), "nothing says that they belong together");
    let metadata = "  relative_file_paths:\n    - base.mcap\n    - laser.mcap\n";
    fs::write(folder.path().join("metadata.yaml"), metadata).unwrap();
    file(folder.path(), "merged.mcap", &bag(1..STEPS, |_| true));
    let (records, _) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(records, whole().0, "the one that the metadata does not name is not read");
}

#[test]
fn our_own_logs_are_read_in_parts_too() {
    let folder = tempfile::tempdir().unwrap();
    let record = |k: u64| Record {
        stamp: Stamp::from_nanoseconds(k * 100_000_000),
        data: RecordData::Velocity(Velocity { linear: k as f64, angular: 0.1 }),
    };
    let parts = [0..400, 400..401, 401..900].map(|range| range.map(record).collect::<Vec<_>>());
    let paths = ["a", "b", "c"].map(|name| folder.path().join(format!("{name}.mcap")));
    for (path, records) in paths.iter().zip(&parts) {
        write(path, LogFormat::Mcap, records.clone()).unwrap();
    }
    let [a, b, c] = &paths;
    let (records, report) = open_all(&[c, a, b], &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(records, parts.concat());
    assert_eq!(report.rows_read, 900);
}

#[test]
fn a_part_that_breaks_off_is_told_and_the_others_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let first = bag(1..20, |_| true);
    file(folder.path(), "drive_0.mcap", &first[..first.len() - 60]);
    file(folder.path(), "drive_1.mcap", &bag(20..STEPS, |_| true));
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(records, whole().0, "only the index is missing");
    assert!(matches!(report.end, LogCompleteness::Truncated { .. }), "{report}");

    let mut other = Bag::new();
    other.put("/amcl_pose", POSE, 60 * SECOND, pose(60, [f64::NAN, 0.0, 0.0]));
    file(folder.path(), "drive_2.mcap", &other.finish());
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(records, whole().0);
    let told: Vec<(&str, u64)> = report.examples.iter().map(|told| (told.file.as_str(), told.row)).collect();
    assert_eq!(told, [("drive_2.mcap", 1)]);
}

#[test]
fn what_cannot_be_parts_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let part = file(folder.path(), "drive_0.mcap", &bag(1..5, |_| true));
    let text = file(folder.path(), "walk.txt", b"O 1 0 0\n");
    let none: [&Path; 0] = [];
    assert!(matches!(open_all(&none, &LogOpenOptions::default()), Err(LogError::NoPath)));
    let error = open_all(&[&part, &text], &LogOpenOptions::default()).unwrap_err();
    assert!(matches!(&error, LogError::NotAPart { path, .. } if *path == text), "{error}");
    let missing = folder.path().join("drive_1.mcap");
    let error = open_all(&[&part, &missing], &LogOpenOptions::default()).unwrap_err();
    assert!(matches!(error, LogError::NotFound { .. }), "{error}");
}
