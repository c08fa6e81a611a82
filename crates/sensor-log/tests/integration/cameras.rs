//! Cameras and images: what is written comes back, what is damaged is named.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::assert_abs_diff_eq;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use foxglove::Encode;
use foxglove::messages::{
    self, CameraCalibration, CompressedImage, FrameTransform, Quaternion, Timestamp,
    Vector3 as FoxgloveVector3,
};
use mcap::WriteOptions;
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use wayfix_estimation_traits::{Pose2, Pose3};
use wayfix_sensor_log::{
    CameraInfo, EncodedImage, ImageFileFormat, LogError, LogFormat, LogOpenOptions, LogSummary, McapWriter,
    ReadReport, Record, RecordData, RowProblemKind, Stamp, convert, open, topics, write,
};

const INFO: CameraInfo = CameraInfo { width: 16, height: 12, fx: 14.25, fy: 14.5, cx: 8.0, cy: 6.125 };

fn rgb(frame: u8) -> Vec<u8> {
    (0..16 * 12 * 3).map(|k| (k as u8).wrapping_mul(7).wrapping_add(frame)).collect()
}

fn mount(angle: f64) -> Pose3<f64> {
    let rotation = UnitQuaternion::from_euler_angles(0.01, 0.4, angle);
    Pose3 { translation: Vector3::new(0.05, -0.01, 0.17), rotation }
}

/// What a robot with a moving camera logs in `n_frames` frames, in the order in which records stand at one stamp.
fn league_drive(n_frames: u8) -> Vec<Record> {
    let at = |frame: u8, data| Record {
        stamp: Stamp::from_nanoseconds(1_000_000_000 + 83_333_333 * u64::from(frame)),
        data,
    };
    let mut records = vec![at(0, RecordData::CameraInfo(INFO))];
    for frame in 0..n_frames {
        let labels: Vec<u8> = (0..16 * 12).map(|k| (k as u8 / 3 + frame) % 6).collect();
        records.push(at(frame, RecordData::OdometryIncrement(Pose2::new(0.01, 0.0, 0.02))));
        records.push(at(frame, RecordData::TruePose(Pose2::new(f64::from(frame), 0.5, 0.1))));
        records.push(at(frame, RecordData::CameraMount(mount(0.1 * f64::from(frame)))));
        records.push(at(frame, RecordData::TrueLabels(EncodedImage::png_gray(16, 12, &labels).unwrap())));
        records.push(at(frame, RecordData::Image(EncodedImage::jpeg(16, 12, &rgb(frame), 90).unwrap())));
    }
    records
}

fn read(path: &Path) -> (Vec<Record>, ReadReport) {
    open(path, &LogOpenOptions::default()).unwrap().read_all()
}

#[test]
fn cameras_round_trip_in_order_with_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // More than the reader holds back, so that the order is not merely that of one look.
    let records = league_drive(100);
    for name in ["a.mcap", "b.mcap"] {
        write(at(name), LogFormat::Mcap, records.clone()).unwrap();
    }
    assert_eq!(fs::read(at("a.mcap")).unwrap(), fs::read(at("b.mcap")).unwrap());
    let (back, report) = read(&at("a.mcap"));
    assert_eq!(back, records);
    assert_eq!(report.n_problems(), 0, "{report}");
    assert_eq!(report.ignored.into_iter().collect::<Vec<_>>(), []);

    convert(open(at("a.mcap"), &LogOpenOptions::default()).unwrap(), at("copy.mcap"), LogFormat::Mcap)
        .unwrap();
    assert_eq!(fs::read(at("copy.mcap")).unwrap(), fs::read(at("a.mcap")).unwrap());

    let left_out = write(at("poses.tum"), LogFormat::Tum, records).unwrap().left_out;
    assert_eq!(left_out["image"], 100);
    assert_eq!(left_out["camera info"], 1);
}

#[test]
fn a_summary_counts_images_by_format_and_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let mut records = league_drive(3);
    let Some(Record { stamp, data: RecordData::Image(last) }) = records.last().cloned() else {
        panic!("an image is last")
    };
    let cut = EncodedImage::new(ImageFileFormat::Jpeg, &last.bytes[..last.bytes.len() / 2]);
    records.push(Record { stamp, data: RecordData::Image(cut) });
    write(&path, LogFormat::Mcap, records).unwrap();
    let summary = LogSummary::of(open(&path, &LogOpenOptions::default()).unwrap());
    assert_eq!(summary.kinds["image"].count, 4);
    let text = summary.to_string();
    assert!(text.contains("  image: 3 jpeg of 16 x 12 pixels, 1 damaged, 0.0 MB\n"), "{text}");
    assert!(text.contains("  true labels: 3 png of 16 x 12 pixels, 0.0 MB\n"), "{text}");
}

/// Everything on one topic, as the protobuf messages that other programs see.
fn messages<M: prost::Message + Default>(bytes: &[u8], topic: &str) -> Vec<M> {
    mcap::MessageStream::new(bytes)
        .unwrap()
        .map(Result::unwrap)
        .filter(|message| message.channel.topic == topic)
        .map(|message| M::decode(&*message.data).unwrap())
        .collect()
}

fn rotation(transform: &FrameTransform) -> UnitQuaternion<f64> {
    let q = transform.rotation.unwrap();
    UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q.w, q.x, q.y, q.z))
}

#[test]
fn viewers_find_the_pixel_that_the_camera_model_says() {
    let mut file = Cursor::new(Vec::new());
    let mut writer = McapWriter::new(&mut file).unwrap();
    league_drive(1).iter().for_each(|record| writer.record(record).unwrap());
    writer.finish().unwrap();
    let bytes = file.into_inner();
    let camera = &messages::<FrameTransform>(&bytes, topics::CAMERA_MOUNT)[0];
    let optical = &messages::<FrameTransform>(&bytes, topics::CAMERA_OPTICAL)[0];
    let calibration = &messages::<CameraCalibration>(&bytes, topics::CAMERA_INFO)[0];
    let image = &messages::<CompressedImage>(&bytes, topics::IMAGE)[0];
    assert_eq!(camera.child_frame_id, optical.parent_frame_id);
    assert_eq!(optical.child_frame_id, image.frame_id);
    assert_eq!(calibration.frame_id, image.frame_id);
    // Foxglove: P (x, y, z, 1) of the optical frame = (u w, v w, w). Ours: u = cx - fx y / x, v = cy - fy z / x.
    let (x, y, z) = (3.0, 0.7, -0.4);
    let seen = rotation(optical).inverse_transform_vector(&Vector3::new(x, y, z));
    let p = nalgebra::Matrix3x4::from_row_slice(&calibration.p) * seen.push(1.0);
    assert_abs_diff_eq!(p.x / p.z, INFO.cx - INFO.fx * y / x, epsilon = 1e-12);
    assert_abs_diff_eq!(p.y / p.z, INFO.cy - INFO.fy * z / x, epsilon = 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn the_mount_comes_back_to_the_bit(
        (roll, pitch, yaw) in (-3.2..3.2_f64, -1.6..1.6_f64, -3.2..3.2_f64),
        (x, y, z) in (-1e3..1e3_f64, -1.0..1.0_f64, 1e-9..2.0_f64),
    ) {
        let pose = Pose3 { translation: Vector3::new(x, y, z), rotation: UnitQuaternion::from_euler_angles(roll, pitch, yaw) };
        let record = Record { stamp: Stamp::from_nanoseconds(7), data: RecordData::CameraMount(pose) };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.mcap");
        write(&path, LogFormat::Mcap, [record.clone()]).unwrap();
        prop_assert_eq!(read(&path).0, [record]);
    }
}

#[test]
fn a_camera_or_image_that_would_not_come_back_is_not_written() {
    let stamp = Stamp::from_nanoseconds(5);
    let refused = |data| {
        let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
        writer.record(&Record { stamp, data }).unwrap_err()
    };
    let error = refused(RecordData::CameraInfo(CameraInfo { cx: f64::NAN, ..INFO }));
    assert!(matches!(error, LogError::NotFinite { what: "camera info", .. }), "{error}");
    let mut pose = mount(0.0);
    pose.translation.z = f64::INFINITY;
    assert!(matches!(
        refused(RecordData::CameraMount(pose)),
        LogError::NotFinite { what: "camera mount", .. }
    ));
    let error = refused(RecordData::CameraInfo(CameraInfo { width: 0, ..INFO }));
    assert!(matches!(error, LogError::BadCamera { width: 0, height: 12, .. }), "{error}");
    let error = refused(RecordData::CameraInfo(CameraInfo { fy: -1.0, ..INFO }));
    assert_eq!(
        error.to_string(),
        "camera at 0.000000005 s: 16 x 12 pixels with focal lengths 14.25 and -1 see nothing"
    );
    let error = refused(RecordData::Image(EncodedImage::new(ImageFileFormat::Png, &[0xFF, 0xD8, 0xFF][..])));
    assert!(
        matches!(error, LogError::NotAnImage { what: "image", format: ImageFileFormat::Png, n_bytes: 3, .. }),
        "{error}"
    );
}

/// What our reader says of a message that another program wrote.
fn problem_of<M: Encode + prost::Message>(topic: &str, message: &M) -> (RowProblemKind, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let mut writer = WriteOptions::new().create(fs::File::create(&path).unwrap()).unwrap();
    let schema = M::get_schema().unwrap();
    let schema_id = writer.add_schema(&schema.name, &schema.encoding, &schema.data).unwrap();
    let channel_id =
        writer.add_channel(schema_id, topic, "protobuf", &std::collections::BTreeMap::new()).unwrap();
    let header = mcap::records::MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
    writer.write_to_known_channel(&header, &message.encode_to_vec()).unwrap();
    // A record that can be read, so that the log opens.
    let pose = messages::PoseInFrame { pose: Some(messages::Pose::default()), ..Default::default() };
    let schema = messages::PoseInFrame::get_schema().unwrap();
    let schema_id = writer.add_schema(&schema.name, &schema.encoding, &schema.data).unwrap();
    let channel_id = writer
        .add_channel(schema_id, topics::TRUE_POSE, "protobuf", &std::collections::BTreeMap::new())
        .unwrap();
    writer
        .write_to_known_channel(
            &mcap::records::MessageHeader { channel_id, ..header },
            &prost::Message::encode_to_vec(&pose),
        )
        .unwrap();
    writer.finish().unwrap();
    let (records, report) = read(&path);
    assert_eq!((records.len(), report.n_problems()), (1, 1), "{report}");
    (report.examples[0].kind, report.examples[0].reason.clone())
}

#[test]
fn cameras_of_other_programs_are_refused_with_a_reason() {
    let calibration = CameraCalibration {
        timestamp: Some(Timestamp::new(1, 0)),
        width: 16,
        height: 12,
        k: vec![14.0, 0.0, 8.0, 0.0, 14.0, 6.0, 0.0, 0.0, 1.0],
        ..Default::default()
    };
    let of = |change: &dyn Fn(&mut CameraCalibration)| {
        let mut changed = calibration.clone();
        change(&mut changed);
        problem_of(topics::CAMERA_INFO, &changed)
    };
    assert_eq!(of(&|c| c.k[4] = f64::NAN).0, RowProblemKind::NotFinite);
    assert_eq!(of(&|c| c.k[0] = 0.0).0, RowProblemKind::Inconsistent);
    assert_eq!(of(&|c| c.height = 0).0, RowProblemKind::Inconsistent);
    assert!(of(&|c| c.k.truncate(6)).1.contains("6 numbers, not 9"));
    assert!(of(&|c| c.d = vec![0.0, -0.2]).1.contains("[0.0, -0.2]; rectify the images"));

    let mount = |x, w| FrameTransform {
        translation: Some(FoxgloveVector3 { x, y: 0.0, z: 0.0 }),
        rotation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w }),
        ..Default::default()
    };
    assert_eq!(problem_of(topics::CAMERA_MOUNT, &mount(f64::NAN, 1.0)).0, RowProblemKind::NotFinite);
    assert_eq!(problem_of(topics::CAMERA_MOUNT, &mount(0.0, f64::INFINITY)).0, RowProblemKind::NotFinite);
    for norm in [1e200, 1e-200, 0.9] {
        let (kind, reason) = problem_of(topics::CAMERA_MOUNT, &mount(0.0, norm));
        assert_eq!(kind, RowProblemKind::Inconsistent, "{reason}");
    }

    let image = CompressedImage {
        data: b"RIFF....WEBP".to_vec().into(),
        format: "webp".into(),
        ..Default::default()
    };
    let (kind, reason) = problem_of(topics::IMAGE, &image);
    assert_eq!(kind, RowProblemKind::UnreadableImage);
    assert!(reason.ends_with("image called \"webp\" is neither JPEG nor PNG (12 bytes)"), "{reason}");
    let empty = CompressedImage { format: "jpeg".into(), ..Default::default() };
    assert_eq!(problem_of(topics::TRUE_LABELS, &empty).0, RowProblemKind::UnreadableImage);
}

#[test]
fn the_content_of_an_image_counts_and_not_what_it_is_called() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let png = EncodedImage::png_rgb(16, 12, &rgb(1)).unwrap();
    let message = CompressedImage {
        data: png.bytes.to_vec().into(),
        format: "bgr8; jpeg compressed bgr8".into(),
        ..Default::default()
    };
    let mut writer = WriteOptions::new().create(fs::File::create(&path).unwrap()).unwrap();
    let schema = CompressedImage::get_schema().unwrap();
    let schema_id = writer.add_schema(&schema.name, &schema.encoding, &schema.data).unwrap();
    let channel_id =
        writer.add_channel(schema_id, topics::IMAGE, "protobuf", &std::collections::BTreeMap::new()).unwrap();
    let header = mcap::records::MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
    writer.write_to_known_channel(&header, &prost::Message::encode_to_vec(&message)).unwrap();
    writer.finish().unwrap();
    assert_eq!(read(&path).0[0].data, RecordData::Image(png));
}
