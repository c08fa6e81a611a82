//! An observer ends a drive.

use wayfix_line_extract::LineExtractionParams;
use wayfix_sensor_log::{LaserScan, Record, RecordData, Stamp};
use wayfix_systems::{
    lines::LineExtractionSystem,
    system::{RunStep, drive},
};

#[test]
fn an_observer_ends_the_drive() {
    let ranges = vec![2.0; 61];
    let scan = LaserScan { angle_min: -0.5, angle_increment: 0.01, range_max: 8.0, beam_period: 0.0, ranges };
    let record =
        |second| Record { stamp: Stamp::from_nanoseconds(second), data: RecordData::Scan(scan.clone()) };
    let records: Vec<Record> = (0..50).map(record).collect();
    let mut system = LineExtractionSystem::new(LineExtractionParams::default()).expect("the defaults");
    drive(&mut system, &records, |RunStep { record, stop, .. }| stop.set(record.stamp.nanoseconds() == 20));
    assert_eq!(system.n_scans(), 21);
}
