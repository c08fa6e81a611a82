//! The reader of CARMEN logs, on text written here.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::abs_diff_eq;
use std::fs;
use std::io::Write;
use std::path::Path;

use flate2::{Compression, write::GzEncoder};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{
    LogCompleteness, LogFormat, LogOpenOptions, PoseKind, ReadReport, Record, RecordData, RowProblemKind,
    open,
};

fn scan_line(n_beams: usize, range: &str, pose: &str, odometry: &str, seconds: f64) -> String {
    let ranges = format!("{range} ").repeat(n_beams);
    format!("FLASER {n_beams} {ranges}{pose} {odometry} {seconds} host {seconds}\n")
}

fn odom_line(pose: &str, seconds: f64) -> String {
    format!("ODOM {pose} 0.1 0 0 {seconds} host {seconds}\n")
}

fn gzip(text: &str) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

fn read(path: &Path, bytes: &[u8]) -> (Vec<Record>, ReadReport) {
    fs::write(path, bytes).unwrap();
    let log = open(path, &LogOpenOptions::default()).unwrap();
    assert_eq!(log.meta().format, LogFormat::Carmen);
    log.read_all()
}

/// Scans a second apart, the robot a quarter of a metre further each time.
fn walk(n_scans: usize) -> String {
    let line = |k: usize| {
        let pose = format!("{} 0 0", 0.25 * k as f64);
        scan_line(180, "1.5", &pose, &pose, k as f64)
    };
    format!(
        "# message formats\nPARAM robot_length 0.5 nohost 0\n{}",
        (1..=n_scans).map(line).collect::<String>()
    )
}

fn n_scans(records: &[Record]) -> usize {
    records.iter().filter(|record| matches!(record.data, RecordData::Scan(_))).count()
}

#[test]
fn a_scan_gives_its_pose_the_motion_and_the_ranges_as_they_came() {
    let folder = tempfile::tempdir().unwrap();
    let text = [
        scan_line(361, "nan", "0 0 0", "0 0 0", 1.0),
        "NEFF 30\n".to_owned(),
        odom_line("0 0 0", 0.0),
        odom_line("0.5 0 0", 3.0),
        scan_line(180, "81.9", "2 0 0.5", "2 0 0.5", 3.0),
        odom_line("2.5 0 0.5", 4.0),
        scan_line(180, "1", "3 0 0.5", "3 0 0.5", 4.0),
    ]
    .concat();
    let (records, report) = read(&folder.path().join("walk.log"), text.as_bytes());
    let kinds: Vec<_> = records.iter().map(|record| (record.stamp.seconds(), record.data.kind())).collect();
    let expected = [
        (1.0, "estimated pose"),
        (1.0, "laser scan"),
        (3.0, "estimated pose"),
        (3.0, "odometry increment"),
        (3.0, "laser scan"),
        (4.0, "estimated pose"),
        (4.0, "odometry increment"),
        (4.0, "laser scan"),
    ];
    assert_eq!(kinds, expected);
    assert_eq!(records[2].data, RecordData::EstimatedPose(Pose2::new(2.0, 0.0, 0.5)));
    assert_eq!(records[3].data, RecordData::OdometryIncrement(Pose2::new(0.5, 0.0, 0.0)));
    let (RecordData::Scan(first), RecordData::Scan(second)) = (&records[1].data, &records[4].data) else {
        panic!("{records:?}");
    };
    assert!(first.ranges.len() == 361 && first.ranges.iter().all(|range| range.is_nan()));
    assert_eq!(first.angle_increment, 0.5_f64.to_radians());
    assert_eq!((second.ranges[179], second.range_max), (81.9, 50.0));
    assert_eq!(second.echoes().count(), 0);
    assert_eq!((report.rows_read, report.n_problems(), report.ignored["NEFF"]), (6, 0, 1));

    let options = LogOpenOptions { poses: PoseKind::True, ..Default::default() };
    let log = open(folder.path().join("walk.log"), &options).unwrap();
    assert_eq!(log.filter(|record| matches!(record.data, RecordData::TruePose(_))).count(), 3);
}

#[test]
fn a_damaged_line_is_counted_and_the_others_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let good = |seconds| scan_line(180, "1", "0 0 0", "0 0 0", seconds);
    let long = "FLASER 180 ".to_owned() + &"1 ".repeat(40_000);
    let text = [
        good(1.0),
        scan_line(180, "1", "0 0", "0 0 0", 2.0),
        scan_line(1, "1", "0 0 0", "0 0 0", 3.0),
        scan_line(180, "one", "0 0 0", "0 0 0", 4.0),
        scan_line(180, "1", "0 nan 0", "0 0 0", 5.0),
        good(-6.0),
        "FLASER\nFLASER 1e300 1\nFLASER -11\nHELLO 1 2\nODOM 0 0\n".to_owned(),
        long + "\n",
        good(7.0),
    ]
    .concat();
    let (records, report) = read(&folder.path().join("bad.log"), text.as_bytes());
    assert_eq!(n_scans(&records), 2);
    let count = |kind| report.problems.get(&kind).copied().unwrap_or_default();
    assert_eq!(count(RowProblemKind::ColumnCount), 4, "{report}");
    assert_eq!(count(RowProblemKind::Inconsistent), 1, "{report}");
    assert_eq!(count(RowProblemKind::NotANumber), 2, "{report}");
    assert_eq!(count(RowProblemKind::NotFinite), 1, "{report}");
    assert_eq!(count(RowProblemKind::BadStamp), 1, "{report}");
    assert_eq!(count(RowProblemKind::Unrecognized), 2, "{report}");
    assert_eq!((report.rows_read, report.n_problems()), (2, 11));
}

#[test]
fn line_order_decides_where_time_does_not_advance() {
    let folder = tempfile::tempdir().unwrap();
    let times = [5.0, 5.0, 4.0, 9.0];
    let text: String = times.iter().map(|t| scan_line(180, "1", "0 0 0", "0 0 0", *t)).collect();
    let (records, report) = read(&folder.path().join("clock.log"), text.as_bytes());
    let scans = records.iter().filter(|record| matches!(record.data, RecordData::Scan(_)));
    let milliseconds: Vec<u64> = scans.map(|record| record.stamp.nanoseconds() / 1_000_000).collect();
    assert_eq!(milliseconds, [5000, 5100, 5200, 9000]);
    assert_eq!((report.rows_read, report.n_problems()), (4, 2));
    assert_eq!(report.problems[&RowProblemKind::NotLater], 2);
}

#[test]
fn raw_scans_alone_move_with_the_odometry_lines() {
    let folder = tempfile::tempdir().unwrap();
    let scan = |t: f64| format!("RAWLASER1 0 -1 2 1 8 0.01 0 3 1 1 1 0 {t} h {t}\n");
    let text = [odom_line("0 0 0", 1.0), scan(1.0), scan(1.5), odom_line("1 0 0", 2.0), scan(2.0)].concat();
    let (records, report) = read(&folder.path().join("raw.log"), text.as_bytes());
    let steps: Vec<f64> =
        records
            .iter()
            .filter_map(|record| {
                if let RecordData::OdometryIncrement(step) = record.data { Some(step.x()) } else { None }
            })
            .collect();
    assert_eq!((n_scans(&records), steps, report.n_problems()), (3, vec![0.5, 0.5], 0));
}

#[test]
fn a_scan_beyond_2106_is_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let good = walk(6);
    let mut lines: Vec<String> = good.lines().map(|line| format!("{line}\n")).collect();
    let (expected, _) = read(&folder.path().join("good.log"), good.as_bytes());
    lines.insert(5, scan_line(180, "1.5", "9 9 9", "9 9 9", 5e9));
    let (records, report) = read(&folder.path().join("late.log"), lines.concat().as_bytes());
    assert_eq!(records, expected);
    assert_eq!((report.rows_read, report.n_problems()), (6, 1));
    assert_eq!((report.examples[0].row, report.examples[0].kind), (6, RowProblemKind::BadStamp));
}

#[test]
fn time_goes_on_where_the_clock_is_set_back() {
    let folder = tempfile::tempdir().unwrap();
    let line = |k: u32| {
        let t = if k < 30 { f64::from(k) } else { f64::from(k) - 20.0 };
        scan_line(180, "1", &format!("{k} 0 0"), &format!("{k} 0 0"), 1000.0 + t)
    };
    let text: String = (0..60).map(line).collect();
    let (records, report) = read(&folder.path().join("clock.log"), text.as_bytes());
    let scans = records.iter().filter(|record| matches!(record.data, RecordData::Scan(_)));
    let stamps: Vec<f64> = scans.map(|record| record.stamp.seconds()).collect();
    assert_eq!((stamps.len(), report.n_problems()), (60, 0));
    assert!(stamps.windows(2).all(|pair| pair[1] > pair[0]));
    assert!(abs_diff_eq!(stamps[59] - stamps[30], 29.0, epsilon = 1e-6), "the pace stays that of the clock");
    assert!(report.warnings.iter().any(|warning| warning.name == "clock_set_back"));
}

#[test]
fn gzip_log_equals_plain_and_truncated_gzip_its_beginning() {
    let folder = tempfile::tempdir().unwrap();
    let text = walk(40);
    let (plain, _) = read(&folder.path().join("walk.log"), text.as_bytes());
    assert_eq!(n_scans(&plain), 40);
    let packed = gzip(&text);
    let (unpacked, report) = read(&folder.path().join("walk"), &packed);
    assert!(unpacked == plain && report.n_problems() == 0 && report.end == LogCompleteness::Complete);

    let half = &packed[..packed.len() - packed.len() / 4];
    let (records, report) = read(&folder.path().join("cut.log.gz"), half);
    assert!((1..40).contains(&n_scans(&records)), "{}", n_scans(&records));
    assert_eq!(records, plain[..records.len()]);
    assert_eq!(report.end, LogCompleteness::Truncated { file_bytes: half.len() as u64, missing_bytes: 1 });

    let mut bad_sum = packed.clone();
    let checksum = packed.len() - 8;
    bad_sum[checksum] ^= 1;
    let (records, report) = read(&folder.path().join("sum.log.gz"), &bad_sum);
    assert_eq!(records, plain);
    assert!(matches!(report.end, LogCompleteness::Damaged { .. }), "{:?}", report.end);
}

#[test]
fn other_text_logs_may_be_compressed_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt.gz");
    fs::write(&path, gzip("O 1 0 0\nZ 7 1 0\n")).unwrap();
    let log = open(&path, &LogOpenOptions::default()).unwrap();
    assert_eq!(log.meta().format, LogFormat::RangeBearing);
    assert_eq!(log.count(), 2);
}
