//! The reader of scans as JSON, on text written here.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::assert_abs_diff_eq;
use std::fs;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{
    LogCompleteness, LogError, LogFormat, LogOpenOptions, ReadReport, Record, RecordData, RowProblemKind,
    open,
};

fn entry(seconds: &str, n_beams: usize, x: &str) -> String {
    let ranges = vec!["1.5"; n_beams].join(", ");
    format!("\"{seconds}\": {{\"range\": [{ranges}], \"theta\": 0.0, \"x\": {x}, \"y\": 0.0}}")
}

fn document(entries: &[String]) -> String {
    format!("\n {{\"comment\": [1, {{}}], \"map\": {{{}}}}}", entries.join(",\n"))
}

fn read(text: &str) -> Result<(Vec<Record>, ReadReport), LogError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scans.json");
    fs::write(&path, text).unwrap();
    let log = open(&path, &LogOpenOptions::default())?;
    assert_eq!(log.meta().format, LogFormat::ScanJson);
    Ok(log.read_all())
}

#[test]
fn keys_are_sorted_as_numbers_and_poses_give_the_motion() {
    let text = document(&[entry("10.5", 180, "1.25"), entry("9.75", 180, "1.0")]);
    let (records, report) = read(&text).unwrap();
    assert!(report.is_clean());
    let stamps: Vec<f64> = records.iter().map(|record| record.stamp.seconds()).collect();
    assert_eq!(stamps, [9.75, 9.75, 10.5, 10.5, 10.5]);
    assert_eq!(records[3].data, RecordData::OdometryIncrement(Pose2::new(0.25, 0.0, 0.0)));
    assert!(matches!(&records[4].data, RecordData::Scan(scan) if scan.ranges == [1.5; 180]));
}

#[test]
fn a_bad_scan_is_counted_and_the_others_are_read() {
    let text = document(&[
        entry("1", 180, "0"),
        entry("2", 1, "0"),
        entry("3", 180, "\"far\""),
        entry("soon", 180, "0"),
        "\"5\": null".to_owned(),
        entry("6", 361, "1"),
    ]);
    let (records, report) = read(&text).unwrap();
    assert_eq!(records.len(), 5);
    assert_eq!((report.rows_read, report.n_problems()), (2, 4));
    assert_eq!(report.problems[&RowProblemKind::Inconsistent], 1);
    assert_eq!(report.problems[&RowProblemKind::NotANumber], 3);
    assert_eq!(report.examples.iter().map(|problem| problem.row).collect::<Vec<_>>(), [2, 3, 4, 5]);
}

#[test]
fn what_comes_before_a_damage_is_read() {
    let entries: Vec<String> = (1..=4).map(|k| entry(&k.to_string(), 180, "0")).collect();
    let text = document(&entries);
    let scans = |records: &[Record]| records.iter().filter(|r| matches!(r.data, RecordData::Scan(_))).count();
    let cut = &text[..text.len() - 100];
    let (records, report) = read(cut).unwrap();
    assert_eq!(scans(&records), 3);
    assert_eq!(report.end, LogCompleteness::Truncated { file_bytes: cut.len() as u64, missing_bytes: 1 });

    let position = text.find("\"3\"").unwrap();
    let bad = format!("{}?{}", &text[..position], &text[position + 1..]);
    let (records, report) = read(&bad).unwrap();
    assert_eq!(scans(&records), 2);
    let LogCompleteness::Damaged { byte, .. } = report.end else { panic!("{:?}", report.end) };
    assert_eq!(byte, position as u64 + 1);

    assert!(matches!(read("{\"a\": 1}"), Err(LogError::Damaged { .. })));
    assert!(matches!(read("{\"map\": {}}"), Err(LogError::Empty { .. })));
    assert!(matches!(read("{"), Err(LogError::Damaged { end: LogCompleteness::Truncated { .. }, .. })));
    assert!(matches!(read(&"{\"map\":".repeat(5000)), Err(LogError::Damaged { .. })));
}

#[test]
fn nan_and_infinity_in_json_are_missing_beams() {
    let one = entry("1.5", 180, "0").replacen("1.5, ", "NaN, ", 1).replacen("1.5, ", "-Infinity, ", 1);
    let one = one.replacen("1.5, ", "null, ", 1).replacen("1.5, ", "Infinity, ", 1);
    let text = document(&[one, entry("2", 180, "0.25"), entry("3", 180, "NaN"), entry("4", 180, "0.5")]);
    let (records, report) = read(&text.replacen("comment", "NaN \\\" NaN", 1)).unwrap();
    let scans: Vec<_> = records
        .iter()
        .filter_map(|record| if let RecordData::Scan(scan) = &record.data { Some(scan) } else { None })
        .collect();
    assert_eq!(scans.len(), 3);
    assert_eq!(scans.iter().map(|scan| scan.echoes().count()).collect::<Vec<_>>(), [176, 180, 180]);
    assert_eq!((report.rows_read, report.n_problems()), (3, 1));
    assert_eq!((report.examples[0].row, report.examples[0].kind), (3, RowProblemKind::NotFinite));
    assert_eq!(report.end, LogCompleteness::Complete);
}

#[test]
fn a_scan_years_off_is_left_out_and_counted() {
    let text = document(&[entry("1.3e9", 180, "0"), entry("1300000001", 180, "0"), entry("5", 180, "9")]);
    let (records, report) = read(&text).unwrap();
    assert_eq!(records[0].stamp.seconds(), 1.3e9);
    assert_eq!((report.rows_read, report.problems[&RowProblemKind::BadStamp]), (2, 1));
}

#[test]
fn another_number_of_beams_spans_the_half_circle_and_is_said() {
    let (records, report) = read(&document(&[entry("1", 541, "0"), entry("2", 541, "0")])).unwrap();
    let RecordData::Scan(scan) = &records[1].data else { panic!("{records:?}") };
    assert_abs_diff_eq!(scan.bearing(540), std::f64::consts::FRAC_PI_2, epsilon = 1e-12);
    let names: Vec<_> = report.warnings.iter().map(|warning| warning.name).collect();
    assert_eq!(names, ["laser_field_of_view_assumed"]);
}
