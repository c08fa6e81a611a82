//! What is written comes back.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use crate::common;

use std::io::Cursor;

use proptest::prelude::*;
use wayfix_estimation_traits::{
    Pose2,
    nalgebra::{Matrix3, Vector2},
};
use wayfix_sensor_log::{
    AckermannDrive, Detection, DetectionTarget, FoxgloveMessageWriter, LaserScan, LogCompleteness, LogError,
    LogFormat, LogOpenOptions, McapMessageSink, McapWriter, MeasuredQuantity, PoseKind, PoseMeasurement,
    Record, RecordData, RowProblemKind, Stamp, TrueLandmark, TruePosition, TrueWall, Velocity, convert, open,
    topics, write,
};

/// Finite numbers of any size; zero only with its plus sign, since protobuf does not store the other.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -100.0..100.0,
        any::<f64>().prop_filter("finite", |x| x.is_finite()),
        Just(0.0),
        Just(f64::MIN_POSITIVE / 4.0),
        Just(f64::MAX),
    ]
    .prop_map(|x| x + 0.0)
}

fn pose() -> impl Strategy<Value = Pose2<f64>> {
    let heading = prop_oneof![-10.0..10.0, -1e-9..1e-9, Just(std::f64::consts::PI)];
    (number(), number(), heading).prop_map(|(x, y, heading)| Pose2::new(x, y, heading))
}

fn target() -> impl Strategy<Value = DetectionTarget> {
    prop_oneof![
        any::<u32>().prop_map(DetectionTarget::Landmark),
        any::<u32>().prop_map(DetectionTarget::Robot),
        any::<u32>().prop_map(DetectionTarget::UnknownCode),
        Just(DetectionTarget::Unlabelled),
    ]
}

fn scan() -> impl Strategy<Value = LaserScan> {
    let angle = || prop_oneof![-7.0..7.0, Just(0.5_f64.to_radians())];
    let range_max = prop_oneof![Just(50.0), Just(f64::INFINITY), 0.0..100.0];
    let range = prop_oneof![number(), Just(f64::NAN), Just(f64::INFINITY), Just(-0.0)];
    let beam_period = prop_oneof![Just(0.0), Just(2.5e-5)];
    (angle(), angle(), range_max, beam_period, prop::collection::vec(range, 0..20)).prop_map(
        |(angle_min, angle_increment, range_max, beam_period, ranges)| LaserScan {
            angle_min: angle_min + 0.0,
            angle_increment,
            range_max,
            beam_period,
            ranges,
        },
    )
}

fn data() -> impl Strategy<Value = RecordData> {
    let detection = (target(), number(), number()).prop_map(|(target, range, bearing)| Detection {
        target,
        range,
        bearing,
    });
    prop_oneof![
        (number(), number()).prop_map(|(linear, angular)| RecordData::Velocity(Velocity { linear, angular })),
        pose().prop_map(RecordData::OdometryIncrement),
        prop::collection::vec(detection, 0..8).prop_map(RecordData::Detections),
        (number(), number()).prop_map(|(wheel_speed, steering)| RecordData::Ackermann(AckermannDrive {
            wheel_speed,
            steering
        })),
        scan().prop_map(RecordData::Scan),
        prop::collection::vec(number(), 0..8).prop_map(RecordData::DetectionWidths),
        (number(), number()).prop_map(|(x, y)| RecordData::TruePosition(TruePosition { x, y })),
        pose().prop_map(RecordData::TruePose),
        (any::<u32>(), number(), number()).prop_map(|(id, x, y)| RecordData::TrueLandmark(TrueLandmark {
            id,
            x,
            y
        })),
        (any::<u32>(), [number(), number(), number(), number()]).prop_map(|(id, [a, b, c, d])| {
            RecordData::TrueWall(TrueWall { id, start: Vector2::new(a, b), end: Vector2::new(c, d) })
        }),
        pose().prop_map(RecordData::EstimatedPose),
        pose_measurement().prop_map(RecordData::PoseMeasurement),
    ]
}

fn pose_measurement() -> impl Strategy<Value = PoseMeasurement> {
    let quantity = prop_oneof![
        (number(), number()).prop_map(|(x, y)| MeasuredQuantity::Position(Vector2::new(x, y))),
        (number(), number())
            .prop_map(|(latitude, longitude)| MeasuredQuantity::Geodetic { latitude, longitude }),
        number().prop_map(MeasuredQuantity::Heading),
        pose().prop_map(MeasuredQuantity::Pose),
    ];
    let covariance = prop::option::of(
        prop::array::uniform6(number())
            .prop_map(|[xx, xy, yy, xh, yh, hh]| Matrix3::new(xx, xy, xh, xy, yy, yh, xh, yh, hh)),
    );
    ("[a-z]{0,5}", quantity, covariance).prop_map(|(frame, quantity, covariance)| PoseMeasurement {
        frame,
        quantity,
        covariance,
    })
}

/// Up to `max` records in time order, often several at one stamp.
fn records(max: usize) -> impl Strategy<Value = Vec<Record>> {
    let gap = prop_oneof![Just(0_u64), 1..3_000_000_000_u64];
    (0..1_u64 << 60, prop::collection::vec((gap, data()), 1..=max)).prop_map(|(start, gaps)| {
        let mut time = start;
        gaps.into_iter()
            .map(|(gap, data)| {
                time += gap;
                Record { stamp: Stamp::from_nanoseconds(time), data }
            })
            .collect()
    })
}

fn to_bytes(records: &[Record]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = McapWriter::new(&mut file).unwrap();
    for record in records {
        writer.record(record).unwrap();
    }
    writer.finish().unwrap();
    file.into_inner()
}

/// Every bit of every number, which `==` does not compare for zeros.
fn bits(record: &Record) -> (u64, String, Vec<u64>) {
    let numbers = match &record.data {
        RecordData::Velocity(velocity) => vec![velocity.linear, velocity.angular],
        RecordData::OdometryIncrement(pose)
        | RecordData::TruePose(pose)
        | RecordData::EstimatedPose(pose) => {
            vec![pose.x(), pose.y(), pose.heading()]
        }
        RecordData::Detections(look) => {
            look.iter().flat_map(|detection| [detection.range, detection.bearing]).collect()
        }
        RecordData::TrueLandmark(landmark) => vec![landmark.x, landmark.y],
        RecordData::TrueWall(wall) => vec![wall.start.x, wall.start.y, wall.end.x, wall.end.y],
        RecordData::Scan(scan) => {
            let LaserScan { angle_min, angle_increment, range_max, beam_period, ranges } = scan;
            [&[*angle_min, *angle_increment, *range_max, *beam_period], ranges.as_slice()].concat()
        }
        RecordData::Ackermann(drive) => vec![drive.wheel_speed, drive.steering],
        RecordData::DetectionWidths(widths) => widths.clone(),
        RecordData::TruePosition(position) => vec![position.x, position.y],
        RecordData::PoseMeasurement(PoseMeasurement { quantity, covariance, .. }) => {
            let values = match quantity {
                MeasuredQuantity::Position(position) => vec![position.x, position.y],
                MeasuredQuantity::Geodetic { latitude, longitude } => vec![*latitude, *longitude],
                MeasuredQuantity::Heading(heading) => vec![*heading],
                MeasuredQuantity::Pose(pose) => vec![pose.x(), pose.y(), pose.heading()],
            };
            values.into_iter().chain(covariance.iter().flatten().copied()).collect()
        }
        other => panic!("{other:?}"),
    };
    (
        record.stamp.nanoseconds(),
        format!("{:?}", record.data),
        numbers.into_iter().map(f64::to_bits).collect(),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn mcap_keeps_every_record_to_the_bit(records in records(40)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.mcap");
        write(&path, LogFormat::Mcap, records.clone()).unwrap();
        let (back, report) = open(&path, &LogOpenOptions::default()).unwrap().read_all();
        prop_assert_eq!(&report.end, &LogCompleteness::Complete);
        prop_assert_eq!(report.n_problems(), 0);
        prop_assert_eq!(back.iter().map(bits).collect::<Vec<_>>(), records.iter().map(bits).collect::<Vec<_>>());
    }

    #[test]
    fn the_same_records_give_the_same_bytes(records in records(20)) {
        prop_assert_eq!(to_bytes(&records), to_bytes(&records));
    }

    #[test]
    fn tum_keeps_poses_to_the_bit_and_stamps_to_the_microsecond(records in records(20)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("poses.txt");
        let poses: Vec<Record> = records
            .into_iter()
            .filter(|record| matches!(record.data, RecordData::TruePose(_)))
            .map(|record| Record { stamp: Stamp::from_nanoseconds(record.stamp.nanoseconds() % (1 << 60)), ..record })
            .collect();
        prop_assume!(!poses.is_empty());
        write(&path, LogFormat::Tum, poses.clone()).unwrap();
        let options = LogOpenOptions { poses: PoseKind::True, ..Default::default() };
        let (back, _) = open(&path, &options).unwrap().read_all();
        prop_assert_eq!(back.len(), poses.len());
        for (back, pose) in back.iter().zip(&poses) {
            prop_assert_eq!(&back.data, &pose.data);
            prop_assert!(back.stamp.seconds_since(pose.stamp).abs() < 1e-6);
        }
    }
}

#[test]
fn a_log_larger_than_a_chunk_comes_back_whole() {
    let records = common::drive(3000);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    write(&path, LogFormat::Mcap, records.clone()).unwrap();
    assert!(std::fs::metadata(&path).unwrap().len() > 1 << 20, "several chunks of 256 KiB");
    let log = open(&path, &LogOpenOptions::default()).unwrap();
    assert_eq!(log.read_all().0, records);
}

#[test]
fn range_bearing_writes_its_kinds_and_names_the_rest() {
    let records = common::drive(20);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt");
    let report = write(&path, LogFormat::RangeBearing, records.clone()).unwrap();
    assert_eq!(report.left_out.into_iter().collect::<Vec<_>>(), [("estimated pose", 20), ("velocity", 20)]);
    let back: Vec<RecordData> =
        open(&path, &LogOpenOptions::default()).unwrap().map(|record| record.data).collect();
    let kept: Vec<RecordData> = records
        .into_iter()
        .map(|record| record.data)
        .filter(|data| !matches!(data, RecordData::EstimatedPose(_) | RecordData::Velocity(_)))
        .collect();
    assert_eq!(back, kept);
}

#[test]
fn consecutive_landmarks_share_a_message_in_order() {
    let at = |id: u32| Vector2::new(f64::from(id), 1.0);
    let landmark = |id| RecordData::TrueLandmark(TrueLandmark { id, x: at(id).x, y: at(id).y });
    let wall = |id| RecordData::TrueWall(TrueWall { id, start: at(id), end: at(id + 1) });
    let data = (0..5).map(landmark).chain((0..7).map(wall)).chain([landmark(9)]);
    let records: Vec<Record> = data.map(|data| Record { stamp: Stamp::default(), data }).collect();
    let bytes = to_bytes(&records);
    assert_eq!(mcap::MessageStream::new(&bytes).unwrap().count(), 3);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    std::fs::write(&path, &bytes).unwrap();
    assert_eq!(open(&path, &LogOpenOptions::default()).unwrap().collect::<Vec<_>>(), records);
}

#[test]
fn a_cloud_without_the_ends_is_no_cloud_of_walls() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let mut writer = McapWriter::create(&path).unwrap();
    writer
        .record(&Record { stamp: Stamp::default(), data: RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0)) })
        .unwrap();
    writer.point_cloud(topics::TRUE_WALLS, Stamp::default(), topics::WORLD_FRAME, &[[1.0, 2.0]]).unwrap();
    writer.finish().unwrap();
    let (records, report) = open(&path, &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!((records.len(), report.problems[&RowProblemKind::Inconsistent]), (1, 1));
}

#[cfg(feature = "zstd")]
#[test]
fn compressed_files_are_smaller_equal_and_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let at = |second: u64| Record {
        stamp: Stamp::from_nanoseconds(second * 1_000_000_000),
        data: RecordData::TruePose(Pose2::new(second as f64, 0.5, 0.1)),
    };
    let records: Vec<Record> = (0..5000).map(at).collect();
    let written = |name: &str, sink: fn(&std::path::Path) -> Sink| {
        let path = folder.path().join(name);
        let mut writer = FoxgloveMessageWriter::into_sink(sink(&path));
        records.iter().for_each(|record| writer.record(record).unwrap());
        writer.finish().unwrap();
        let read: Vec<Record> = open(&path, &LogOpenOptions::default()).unwrap().collect();
        assert_eq!(read, records, "{name}");
        std::fs::read(path).unwrap()
    };
    let plain = written("plain.mcap", |path| McapMessageSink::create(path).unwrap());
    let one = written("one.mcap", |path| McapMessageSink::create_compressed(path).unwrap());
    let other = written("other.mcap", |path| McapMessageSink::create_compressed(path).unwrap());
    assert_eq!(one, other);
    assert!(2 * one.len() < plain.len(), "{} of {} bytes", one.len(), plain.len());
}

#[cfg(feature = "zstd")]
type Sink = McapMessageSink<std::io::BufWriter<std::fs::File>>;

#[test]
fn what_cannot_be_stored_is_refused() {
    let record = |nanoseconds, linear| Record {
        stamp: Stamp::from_nanoseconds(nanoseconds),
        data: RecordData::Velocity(Velocity { linear, angular: 0.0 }),
    };
    let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
    assert!(matches!(
        writer.record(&record(5, f64::NAN)),
        Err(LogError::NotFinite { what: "velocity", stamp }) if stamp.nanoseconds() == 5
    ));
    assert!(matches!(writer.record(&record(u64::MAX, 1.0)), Err(LogError::StampTooLate { .. })));
    let endless = TrueWall { id: 1, start: Vector2::zeros(), end: Vector2::new(0.0, f64::INFINITY) };
    let endless = Record { stamp: Stamp::default(), data: RecordData::TrueWall(endless) };
    assert!(matches!(writer.record(&endless), Err(LogError::NotFinite { what: "true wall", .. })));
    assert!(matches!(write("nowhere", LogFormat::Utias, []), Err(LogError::NotWritable { .. })));
    let folder = tempfile::tempdir().unwrap();
    let bad =
        Record { stamp: Stamp::default(), data: RecordData::TruePose(Pose2::new(f64::INFINITY, 0.0, 0.0)) };
    let path = folder.path().join("poses.txt");
    assert!(matches!(write(path, LogFormat::Tum, [bad]), Err(LogError::NotFinite { .. })));
}

#[test]
fn conversion_keeps_the_origin_in_a_truncated_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let open_at = |name| open(at(name), &LogOpenOptions::default()).unwrap();
    write(at("walk.txt"), LogFormat::RangeBearing, common::drive(20)).unwrap();
    convert(open_at("walk.txt"), at("first.mcap"), LogFormat::Mcap).unwrap();
    convert(open_at("first.mcap"), at("second.mcap"), LogFormat::Mcap).unwrap();
    let bytes = std::fs::read(at("first.mcap")).unwrap();
    assert_eq!(std::fs::read(at("second.mcap")).unwrap(), bytes);
    std::fs::write(at("cut.mcap"), &bytes[..bytes.len() / 2]).unwrap();
    for name in ["first.mcap", "cut.mcap"] {
        let meta = open_at(name).meta().clone();
        assert_eq!((meta.format, meta.origin), (LogFormat::Mcap, Some(LogFormat::RangeBearing)));
        assert_eq!(meta.first_format(), LogFormat::RangeBearing);
    }

    write(at("plain.mcap"), LogFormat::Mcap, common::drive(20)).unwrap();
    convert(open_at("plain.mcap"), at("copy.mcap"), LogFormat::Mcap).unwrap();
    assert_eq!(std::fs::read(at("copy.mcap")).unwrap(), std::fs::read(at("plain.mcap")).unwrap());
    assert_eq!(open_at("copy.mcap").meta().origin, None);
}

#[test]
fn a_log_is_not_replaced_while_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    write(&path, LogFormat::Mcap, common::drive(20)).unwrap();
    let before = std::fs::read(&path).unwrap();
    let again = folder.path().join(".").join("log.mcap");
    let error =
        convert(open(&path, &LogOpenOptions::default()).unwrap(), again, LogFormat::Mcap).unwrap_err();
    assert!(matches!(error, LogError::SameFile { .. }));
    assert_eq!(std::fs::read(&path).unwrap(), before);
    let error =
        convert(open(&path, &LogOpenOptions::default()).unwrap(), folder.path(), LogFormat::Tum).unwrap_err();
    assert!(matches!(error, LogError::NotCreated { .. }), "{error}");
}
