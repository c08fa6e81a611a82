//! The reader of the Victoria Park set, on files written here.

use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::Path;

use wayfix_sensor_log::{
    AckermannDrive, Detection, DetectionTarget, LogError, LogFormat, LogOpenOptions, MeasuredQuantity,
    PoseMeasurement, Record, RecordData, RowProblemKind, Stamp, TruePosition, open,
};

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("the scratch folder is writable");
}

fn set(folder: &Path) {
    write(folder, "odometry.csv", "t_s,speed_mps,steering_rad\n1.000,0.5,-0.1\n1.025,0.75,0.2\n");
    write(folder, "trees.csv", "t_s,range_m,bearing_rad,diameter_m\n1.025,20,1.0,0.3\n1.025,10,2.5,0.4\n");
    write(folder, "gps.csv", "t_s,x_m,y_m\n1.025,-67.5,-41.75\n");
}

fn at(milliseconds: u64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_nanoseconds(milliseconds * 1_000_000), data }
}

#[test]
fn the_three_files_are_merged_and_bearings_turned_ahead() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    let log = open(folder.path(), &LogOpenOptions::default()).unwrap();
    assert_eq!(log.meta().format, LogFormat::VictoriaPark);
    let (records, report) = log.read_all();
    let tree = |range, bearing| Detection { target: DetectionTarget::Unlabelled, range, bearing };
    let drive = |wheel_speed, steering| RecordData::Ackermann(AckermannDrive { wheel_speed, steering });
    let expected = [
        at(1000, drive(0.5, -0.1)),
        at(1025, RecordData::TruePosition(TruePosition { x: -67.5, y: -41.75 })),
        at(1025, drive(0.75, 0.2)),
        at(1025, RecordData::DetectionWidths(vec![0.3, 0.4])),
        at(1025, RecordData::Detections(vec![tree(20.0, 1.0 - FRAC_PI_2), tree(10.0, 2.5 - FRAC_PI_2)])),
    ];
    assert_eq!(records, expected);
    assert_eq!((report.rows_read, report.n_problems()), (5, 0));
}

#[test]
fn bad_rows_are_counted_and_the_rest_is_read() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    let rows = "t_s,speed_mps,steering_rad\n2,1,0\n1,1,0\n3,nan,0\n3,1\n-1,1,0\n3,fast,0\n4,1,0";
    write(folder.path(), "odometry.csv", rows);
    let jump = "t_s,x_m,y_m\n1,0,0\n2,0,100\n3,1,0\n";
    write(folder.path(), "gps.csv", jump);
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    let count = |is: fn(&RecordData) -> bool| records.iter().filter(|record| is(&record.data)).count();
    assert_eq!(count(|data| matches!(data, RecordData::Ackermann(_))), 3);
    assert_eq!(count(|data| matches!(data, RecordData::TruePosition(_))), 2);
    assert!(records.is_sorted_by_key(|record| record.stamp));
    for kind in [
        RowProblemKind::OutOfOrder,
        RowProblemKind::NotFinite,
        RowProblemKind::ColumnCount,
        RowProblemKind::BadStamp,
        RowProblemKind::NotANumber,
        RowProblemKind::Inconsistent,
    ] {
        assert_eq!(report.problems.get(&kind), Some(&1), "{kind}");
    }
    let named: Vec<String> = report.examples.iter().map(ToString::to_string).collect();
    assert_eq!(named[0], "gps.csv:3: fix 100 m from the one before and 100 m from the one after");
}

#[test]
fn a_fix_with_a_sigma_is_a_measurement_and_no_truth() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    let rows = "t_s,x_m,y_m,sigma_m\n1,-67.5,-41.75,\n2,-60,-40,5.3\n3,500,0,5.3\n4,-50,-40,\n5,0,0,far\n6,0,0,-1\n7,0,0,0\n";
    write(folder.path(), "gps.csv", rows);
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    let measured = records.iter().filter_map(|record| match &record.data {
        RecordData::PoseMeasurement(measured) => Some(measured.clone()),
        _ => None,
    });
    let measured: Vec<PoseMeasurement> = measured.collect();
    assert_eq!(measured.len(), 2, "a filter gates the jump, not the reader");
    let first = &measured[0];
    assert_eq!(first.quantity, MeasuredQuantity::Position([-60.0, -40.0].into()));
    assert_eq!((first.frame.as_str(), first.covariance.unwrap().m11), ("world", 5.3 * 5.3));
    let truths = records.iter().filter(|record| matches!(record.data, RecordData::TruePosition(_)));
    assert_eq!(truths.count(), 2);
    assert_eq!(report.problems.get(&RowProblemKind::NotANumber), Some(&1));
    assert_eq!(report.problems.get(&RowProblemKind::Inconsistent), Some(&2), "sigmas that are not positive");
}

#[test]
fn gps_may_be_missing_the_other_files_not() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    fs::remove_file(folder.path().join("gps.csv")).unwrap();
    let options = LogOpenOptions { format: Some(LogFormat::VictoriaPark), ..Default::default() };
    assert_eq!(open(folder.path(), &options).unwrap().count(), 4);
    let file = open(folder.path().join("trees.csv"), &options).unwrap_err();
    assert!(matches!(file, LogError::NotThisFormat { format: LogFormat::VictoriaPark, .. }));
    write(folder.path(), "odometry.csv", "time,speed,steering\n1,1,0\n");
    let error = open(folder.path(), &options).unwrap_err().to_string();
    assert!(error.contains("\"time,speed,steering\" instead of \"t_s,speed_mps,steering_rad\""), "{error}");
    fs::remove_file(folder.path().join("odometry.csv")).unwrap();
    assert!(matches!(open(folder.path(), &options), Err(LogError::NotFound { .. })));
}

#[test]
fn a_fifth_column_says_which_tree_it_is_where_somebody_knows() {
    let folder = tempfile::tempdir().unwrap();
    set(folder.path());
    let labelled = "t_s,range_m,bearing_rad,diameter_m,landmark\n1.025,20,1.0,0.3,7\n1.025,10,2.5,0.4,\n1.025,9,2.5,0.4,oak\n";
    write(folder.path(), "trees.csv", labelled);
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    let look = records.iter().find_map(|record| match &record.data {
        RecordData::Detections(look) => {
            Some(look.iter().map(|detection| detection.target).collect::<Vec<_>>())
        }
        _ => None,
    });
    assert_eq!(look.unwrap(), [DetectionTarget::Landmark(7), DetectionTarget::Unlabelled]);
    assert_eq!(report.problems.get(&RowProblemKind::NotANumber), Some(&1));
}
