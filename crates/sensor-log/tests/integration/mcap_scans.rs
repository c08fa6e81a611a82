//! Scans, car odometry and positions as other programs write them.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;

use foxglove::Encode;
use foxglove::messages::{JointState, JointStates, LaserScan as ScanMessage, Pose, Vector3};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use wayfix_sensor_log::{
    AckermannDrive, LaserScan, LogOpenOptions, McapWriter, ReadReport, Record, RecordData, RowProblemKind,
    Stamp, open, topics,
};

type File = Writer<Cursor<Vec<u8>>>;

fn add<M: Encode + prost::Message>(file: &mut File, topic: &str, metadata: &[(&str, &str)], message: &M) {
    let schema = M::get_schema().unwrap();
    let schema_id = file.add_schema(&schema.name, &schema.encoding, &schema.data).unwrap();
    let pairs = metadata.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
    let metadata: BTreeMap<String, String> = pairs.collect();
    let channel_id = file.add_channel(schema_id, topic, "protobuf", &metadata).unwrap();
    let header = MessageHeader { channel_id, sequence: 0, log_time: 7, publish_time: 7 };
    file.write_to_known_channel(&header, &message.encode_to_vec()).unwrap();
}

fn read(fill: impl FnOnce(&mut File)) -> (Vec<RecordData>, ReadReport) {
    let mut file = WriteOptions::new().create(Cursor::new(Vec::new())).unwrap();
    fill(&mut file);
    file.finish().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    fs::write(&path, file.into_inner().into_inner()).unwrap();
    let (records, report) = open(&path, &LogOpenOptions::default()).unwrap().read_all();
    (records.into_iter().map(|record| record.data).collect(), report)
}

fn message(start_angle: f64, end_angle: f64, ranges: &[f64]) -> ScanMessage {
    ScanMessage { start_angle, end_angle, ranges: ranges.to_vec(), ..Default::default() }
}

#[test]
fn scan_without_metadata_takes_its_step_from_the_angles() {
    let (data, report) = read(|file| {
        add(file, topics::SCAN, &[], &message(-1.0, 1.0, &[1.0, f64::NAN, 90.0, 2.0, 3.0]));
        add(file, topics::SCAN, &[], &message(0.25, 0.25, &[4.0]));
        add(file, topics::SCAN, &[], &message(0.0, 0.0, &[]));
    });
    assert!(report.problems.is_empty(), "{report}");
    assert_eq!(report.warnings[0].name, "range_limit_unknown");
    let scans: Vec<&LaserScan> = data
        .iter()
        .map(|data| match data {
            RecordData::Scan(scan) => scan,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(scans[0].echoes().collect::<Vec<_>>(), [(-1.0, 1.0), (0.0, 90.0), (0.5, 2.0), (1.0, 3.0)]);
    assert_eq!((scans[1].angle_min, scans[1].angle_increment), (0.25, 0.0));
    assert!(scans[2].ranges.is_empty());
}

#[test]
fn metadata_that_are_no_numbers_are_as_good_as_none() {
    for bad in ["", "wide", "NaN"] {
        let (data, _) = read(|file| {
            let metadata = [("angle_increment", bad), ("range_max", bad)];
            add(file, topics::SCAN, &metadata, &message(0.0, 1.0, &[1.0, 1.0]));
        });
        let expected = LaserScan {
            angle_min: 0.0,
            angle_increment: 1.0,
            range_max: f64::INFINITY,
            beam_period: 0.0,
            ranges: vec![1.0, 1.0],
        };
        assert_eq!(data, [RecordData::Scan(expected)], "{bad:?}");
    }
}

#[test]
fn what_cannot_be_placed_or_is_no_number_is_counted() {
    let moved = Pose { position: Some(Vector3 { x: 0.3, y: 0.0, z: 0.0 }), orientation: None };
    let wheel = JointState { name: "wheel".to_owned(), velocity: Some(1.0), ..Default::default() };
    let steering = JointState { name: "steering".to_owned(), position: Some(f64::NAN), ..Default::default() };
    let (data, report) = read(|file| {
        add(file, topics::SCAN, &[], &ScanMessage { pose: Some(moved), ..message(0.0, 1.0, &[1.0]) });
        add(file, topics::SCAN, &[], &message(f64::INFINITY, 1.0, &[1.0]));
        let joints = vec![wheel.clone()];
        add(file, topics::ACKERMANN, &[], &JointStates { joints, timestamp: None });
        let joints = vec![wheel.clone(), steering.clone()];
        add(file, topics::ACKERMANN, &[], &JointStates { joints, timestamp: None });
        let joints = vec![JointState { position: Some(-0.5), ..steering }, wheel];
        add(file, topics::ACKERMANN, &[], &JointStates { joints, timestamp: None });
    });
    assert_eq!(data, [RecordData::Ackermann(AckermannDrive { wheel_speed: 1.0, steering: -0.5 })]);
    assert_eq!(report.problems[&RowProblemKind::Inconsistent], 2);
    assert_eq!(report.problems[&RowProblemKind::NotFinite], 2);
}

#[test]
fn scans_of_two_devices_keep_their_own_angles() {
    let scan = |angle_increment, range_max| {
        RecordData::Scan(LaserScan {
            angle_min: 0.1,
            angle_increment,
            range_max,
            beam_period: 0.0,
            ranges: vec![1.0; 3],
        })
    };
    let scans =
        [scan(1.0_f64.to_radians(), 50.0), scan(0.1, f64::INFINITY), scan(1.0_f64.to_radians(), 50.0)];
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = McapWriter::new(&mut bytes).unwrap();
    for data in &scans {
        writer.record(&Record { stamp: Stamp::from_nanoseconds(5), data: data.clone() }).unwrap();
    }
    writer.finish().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    fs::write(&path, bytes.into_inner()).unwrap();
    let back: Vec<RecordData> =
        open(&path, &LogOpenOptions::default()).unwrap().map(|record| record.data).collect();
    assert_eq!(back, scans);
}
