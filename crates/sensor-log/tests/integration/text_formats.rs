//! The text readers, on files written here.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::fs;
use std::path::Path;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{
    Detection, DetectionTarget, LogError, LogFormat, LogOpenOptions, PoseKind, ReadReport, Record,
    RecordData, RowProblemKind, Stamp, TrueLandmark, Velocity, open,
};

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("the scratch folder is writable");
}

fn utias_set(folder: &Path, robots: &[u32]) {
    write(folder, "Barcodes.dat", "# Subject Barcode\n 1 5\n 2 14\n 6 72\n 7 27\n");
    write(folder, "Landmark_Groundtruth.dat", "# header\n 6 1.5 -2 0.1 0.1\n 7 0 3 0.1 0.1\n");
    for robot in robots {
        let name = |kind| format!("Robot{robot}_{kind}.dat");
        write(folder, &name("Groundtruth"), "100.5 1 2 3\n100.0 0 0 0\n");
        write(folder, &name("Odometry"), "100.0\t0.1\t-0.2\n100.25 nan 0\n");
        write(folder, &name("Measurement"), "100.5 72 1 0.5\n100.5 14 2 -0.5\n100.5 99 3 0\n100.75 27 4 1\n");
    }
}

fn at(seconds: f64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_seconds(seconds).expect("a time of this century"), data }
}

fn detection(target: DetectionTarget, range: f64, bearing: f64) -> Detection {
    Detection { target, range, bearing }
}

#[test]
fn utias_files_are_merged_by_time_and_codes_become_subjects() {
    let folder = tempfile::tempdir().unwrap();
    utias_set(folder.path(), &[2]);
    let log = open(folder.path(), &LogOpenOptions::default()).unwrap();
    assert_eq!((log.meta().format, log.meta().robot), (LogFormat::Utias, Some(2)));
    let (records, report) = log.read_all();
    let look = vec![
        detection(DetectionTarget::Landmark(6), 1.0, 0.5),
        detection(DetectionTarget::Robot(2), 2.0, -0.5),
        detection(DetectionTarget::UnknownCode(99), 3.0, 0.0),
    ];
    let expected = [
        at(100.0, RecordData::TrueLandmark(TrueLandmark { id: 6, x: 1.5, y: -2.0 })),
        at(100.0, RecordData::TrueLandmark(TrueLandmark { id: 7, x: 0.0, y: 3.0 })),
        at(100.0, RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0))),
        at(100.0, RecordData::Velocity(Velocity { linear: 0.1, angular: -0.2 })),
        at(100.5, RecordData::TruePose(Pose2::new(1.0, 2.0, 3.0))),
        at(100.5, RecordData::Detections(look)),
        at(100.75, RecordData::Detections(vec![detection(DetectionTarget::Landmark(7), 4.0, 1.0)])),
    ];
    assert_eq!(records, expected);
    let problems: Vec<String> = report.examples.iter().map(ToString::to_string).collect();
    assert!(problems[0].starts_with("Robot2_Groundtruth.dat:2: 100.000000000 s comes after 100.500000000 s"));
    assert_eq!(problems[1], "Robot2_Odometry.dat:2: \"nan\" is not finite");
    assert_eq!(report.n_problems(), 2);
}

#[test]
fn a_set_of_several_robots_asks_which_and_names_them() {
    let folder = tempfile::tempdir().unwrap();
    utias_set(folder.path(), &[3, 1]);
    let open_robot = |robot| open(folder.path(), &LogOpenOptions { robot, ..Default::default() });
    assert!(matches!(open_robot(None), Err(LogError::RobotNeeded { present, .. }) if present == [1, 3]));
    assert!(
        matches!(open_robot(Some(2)), Err(LogError::NoSuchRobot { robot: 2, present, .. }) if present == [1, 3])
    );
    assert_eq!(open_robot(Some(3)).unwrap().meta().robot, Some(3));
}

#[test]
fn range_bearing_lines_make_steps_of_a_tenth_of_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let lines =
        "# two steps\nL 4 1 2\nP 0 0 0\nO 0 0 0\nZ 4 2 0.5\nZ -1 3 1\nP 1 0 0\nO 1 0 0\nO 1 0 0\nZ ? 1 1\n";
    write(folder.path(), "walk.log", lines);
    let (records, report) =
        open(folder.path().join("walk.log"), &LogOpenOptions::default()).unwrap().read_all();
    let step = |x| RecordData::OdometryIncrement(Pose2::new(x, 0.0, 0.0));
    let look = vec![
        detection(DetectionTarget::Landmark(4), 2.0, 0.5),
        detection(DetectionTarget::Unlabelled, 3.0, 1.0),
    ];
    let expected = [
        at(0.0, RecordData::TrueLandmark(TrueLandmark { id: 4, x: 1.0, y: 2.0 })),
        at(0.0, RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0))),
        at(0.0, step(0.0)),
        at(0.0, RecordData::Detections(look)),
        at(0.1, RecordData::TruePose(Pose2::new(1.0, 0.0, 0.0))),
        at(0.1, step(1.0)),
        at(0.2, step(1.0)),
        at(0.2, RecordData::Detections(vec![detection(DetectionTarget::Unlabelled, 1.0, 1.0)])),
    ];
    assert_eq!(records, expected);
    assert_eq!((report.rows_read, report.n_problems()), (9, 0));
}

#[test]
fn tum_headings_come_from_the_quaternion_for_both_signs() {
    let folder = tempfile::tempdir().unwrap();
    let half = 0.65_f64;
    let (sin, cos) = half.sin_cos();
    let rows = format!(
        "1 2 3 0 0 0 {sin} {cos}\n2 0 0 0 0 0 {} {}\n3 0 0 0 0 0 {} {cos}\n4 0 0 0 0 0 0 0\n",
        -sin, -cos, -sin
    );
    write(folder.path(), "poses.txt", &rows);
    let options = LogOpenOptions { poses: PoseKind::True, ..Default::default() };
    let (records, report) = open(folder.path().join("poses.txt"), &options).unwrap().read_all();
    let headings: Vec<f64> = records
        .iter()
        .map(|record| match &record.data {
            RecordData::TruePose(pose) => pose.heading(),
            other => panic!("{other:?}"),
        })
        .collect();
    for (heading, expected) in headings.iter().zip([1.3, 1.3, -1.3]) {
        assert_abs_diff_eq!(*heading, expected, epsilon = 1e-15);
    }
    assert_eq!(headings.len(), 3);
    assert_eq!(report.problems[&RowProblemKind::Inconsistent], 1);
}

#[test]
fn every_kind_of_bad_row_is_counted_and_none_stops_the_reading() {
    let folder = tempfile::tempdir().unwrap();
    let long = "Z 1 ".repeat(20_000);
    let mut bytes = format!("O 1 0 0\nO 1 0\nO 1 0 inf\nQ 1 2 3\nZ x 1 1\n{long}\n").into_bytes();
    bytes.extend(b"O \xff\xfe 1 1\nO 2 0 0\n");
    fs::write(folder.path().join("bad.txt"), bytes).unwrap();
    let (records, report) =
        open(folder.path().join("bad.txt"), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(records.len(), 2);
    let rows: Vec<u64> = report.examples.iter().map(|problem| problem.row).collect();
    assert_eq!(rows, [2, 3, 4, 5, 6, 7]);
    assert_eq!(report.problems[&RowProblemKind::ColumnCount], 1);
    assert_eq!(report.problems[&RowProblemKind::NotFinite], 1);
    assert_eq!(report.problems[&RowProblemKind::NotANumber], 1);
    assert_eq!(report.problems[&RowProblemKind::Unrecognized], 3);
}

#[test]
fn the_report_names_the_first_twenty_and_counts_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "bad.txt", &format!("O 1 0 0\n{}", "O 1 0\n".repeat(50)));
    let (_, report) = open(folder.path().join("bad.txt"), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!((report.n_problems(), report.examples.len()), (50, 20));
    assert!(report.to_string().contains("… and 30 more"));
}

#[test]
fn what_cannot_be_opened_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let fails = |name: &str, format| {
        open(at(name), &LogOpenOptions { format, ..Default::default() }).expect_err("must not open")
    };
    write(folder.path(), "empty.txt", "# nothing\n\n");
    write(folder.path(), "letter.txt", "Dear sir,\n");
    write(folder.path(), "walk.txt", "O 1 0 0\n");
    assert!(matches!(fails("absent", None), LogError::NotFound { .. }));
    assert!(matches!(fails("", None), LogError::IsADirectory { .. }));
    assert!(matches!(fails("", Some(LogFormat::Utias)), LogError::IsADirectory { .. }));
    assert!(matches!(fails("", Some(LogFormat::Tum)), LogError::IsADirectory { .. }));
    assert!(matches!(fails("empty.txt", None), LogError::Empty { .. }));
    assert!(matches!(fails("empty.txt", Some(LogFormat::Tum)), LogError::Empty { .. }));
    assert!(matches!(fails("letter.txt", None), LogError::UnknownFormat { .. }));
    assert!(matches!(
        fails("walk.txt", Some(LogFormat::Tum)),
        LogError::NotThisFormat { format: LogFormat::Tum, .. }
    ));
    assert!(matches!(fails("walk.txt", Some(LogFormat::Utias)), LogError::NotThisFormat { .. }));
}

/// Opens a text that is written as `name`.
fn read_text(folder: &Path, name: &str, bytes: &[u8]) -> (LogFormat, Vec<Record>, ReadReport) {
    fs::write(folder.join(name), bytes).expect("the scratch folder is writable");
    let log = open(folder.join(name), &LogOpenOptions::default()).expect("a log of a known format");
    let format = log.meta().format;
    let (records, report) = log.read_all();
    (format, records, report)
}

#[test]
fn a_utias_row_years_off_is_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    utias_set(folder.path(), &[1]);
    let rows = |row: fn(f64) -> String| -> Vec<String> {
        (0..9).map(|k| row(1_288_971_842.0 + f64::from(k))).collect()
    };
    let mut odometry = rows(|t| format!("{t} 0.1 0\n"));
    odometry.insert(4, "5.0 0.3 0.1\n".to_owned());
    let mut detections = rows(|t| format!("{t} 72 1 0.5\n"));
    detections.push("9e9 72 1 0.5\n".to_owned());
    write(folder.path(), "Robot1_Groundtruth.dat", &rows(|t| format!("{t} 0 0 0\n")).concat());
    write(folder.path(), "Robot1_Odometry.dat", &odometry.concat());
    write(folder.path(), "Robot1_Measurement.dat", &detections.concat());
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(records.first().map(|record| record.stamp.seconds()), Some(1_288_971_842.0));
    assert_eq!(records.last().map(|record| record.stamp.seconds()), Some(1_288_971_850.0));
    assert_eq!(report.problems[&RowProblemKind::BadStamp], 2);
    let rows: Vec<u64> = report.examples.iter().map(|problem| problem.row).collect();
    assert_eq!(rows, [5, 10]);
}

#[test]
fn poses_after_a_clock_set_back_are_not_sorted_in() {
    let folder = tempfile::tempdir().unwrap();
    let row = |t: f64, x: u32| format!("{t} {x} 0 0 0 0 0 1\n");
    let first = (0..30).map(|k| row(1000.0 + f64::from(k), 0));
    let second = (0..20).map(|k| row(1010.5 + f64::from(k), 9));
    let text: String = first.chain(second).collect();
    let (_, records, report) = read_text(folder.path(), "poses.tum", text.as_bytes());
    assert_eq!(records.len(), 30);
    assert!(records.iter().all(|record| record.data == RecordData::EstimatedPose(Pose2::new(0.0, 0.0, 0.0))));
    assert_eq!((report.rows_read, report.problems[&RowProblemKind::TooLate]), (30, 20));
    assert_eq!(report.warnings.iter().map(|warning| warning.name).collect::<Vec<_>>(), ["clock_set_back"]);
}

#[test]
fn tum_columns_are_read_by_their_names_and_with_commas() {
    let folder = tempfile::tempdir().unwrap();
    let (sin, cos) = 0.65_f64.sin_cos();
    let texts = [
        format!("# timestamp tx ty tz qx qy qz qw\n1 2 3 0 0 0 {sin} {cos}\n"),
        format!("# timestamp tx ty tz qw qx qy qz\n1 2 3 0 {cos} 0 0 {sin}\n"),
        format!("timestamp,tx,ty,tz,qw,qx,qy,qz\n1,2,3,0,{cos},0,0,{sin}\n"),
        format!("1, 2, 3, 0, 0, 0, {sin}, {cos}\n"),
    ];
    for text in texts {
        let (format, records, _) = read_text(folder.path(), "poses.txt", text.as_bytes());
        assert_eq!(format, LogFormat::Tum);
        let [Record { data: RecordData::EstimatedPose(pose), .. }] = records[..] else {
            panic!("{text}: {records:?}")
        };
        assert!(abs_diff_eq!(pose.heading(), 1.3, epsilon = 1e-15) && pose.x() == 2.0, "{text}: {pose:?}");
    }
}

#[test]
fn tum_has_one_kind_of_pose() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("path.tum");
    let pose = |x: f64| Pose2::new(x, 0.0, 0.0);
    let truth = [at(1.0, RecordData::TruePose(pose(1.0))), at(2.0, RecordData::TruePose(pose(2.0)))];
    let estimate = at(1.0, RecordData::EstimatedPose(pose(1.1)));
    let written = |records: Vec<Record>| {
        let report = wayfix_sensor_log::write(&path, LogFormat::Tum, records).expect("finite poses");
        let rows = fs::read_to_string(&path).expect("a file").lines().count();
        (rows, report.records_written, report.left_out.values().sum::<u64>())
    };
    assert_eq!(written(truth.to_vec()), (2, 2, 0));
    assert_eq!(written([&truth[..], &[estimate]].concat()), (1, 1, 2));
}
