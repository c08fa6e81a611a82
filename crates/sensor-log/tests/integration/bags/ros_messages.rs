//! Messages of ROS 2 as the Python package rosbags writes them (`data/make_ros2_messages.py`), whole, cut and damaged.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a panic is the verdict of a test, in its helpers too")]

use crate::common::cdr::Encoder;
use proptest::prelude::*;
use wayfix_sensor_log::ros::{
    CameraInfo, CdrError, CompressedImage, Header, Image, LaserScan, Odometry, Pose, PoseStamped, RosMessage,
    RosSchema, TransformStamped, Twist, TwistStamped,
};

/// Type and bytes of every golden message.
fn golden() -> Vec<(RosSchema, Vec<u8>)> {
    let text = include_str!("../../data/ros2_messages.txt");
    let messages: Vec<_> = text.lines().map(golden_line).collect();
    assert_eq!(messages.len(), 20, "ten types in two byte orders");
    messages
}

fn golden_line(line: &str) -> (RosSchema, Vec<u8>) {
    let [schema, _order, hex] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
    let byte = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).unwrap();
    (RosSchema::named(schema).unwrap(), (0..hex.len()).step_by(2).map(byte).collect())
}

fn header(frame_id: &str) -> Header<'_> {
    Header { sec: 1_700_000_000, nanosec: 123_456_789, frame_id }
}

const POSE: Pose = Pose { position: [1.5, -2.25, 0.125], orientation: [0.0, 0.0, 0.6, 0.8] };
const TWIST: Twist = Twist { linear: [0.5, 0.0, 0.0], angular: [0.0, 0.0, -0.25] };

/// The numbers of `make_ros2_messages.py`.
fn expected(schema: RosSchema) -> RosMessage<'static> {
    let count = |from: f64| move |at: usize| from + at as f64;
    let transform =
        |parent, child_frame_id| TransformStamped { header: header(parent), child_frame_id, transform: POSE };
    match schema {
        RosSchema::LaserScan => RosMessage::LaserScan(LaserScan {
            header: header("laser"),
            angle_min: -1.5,
            angle_max: 1.5,
            angle_increment: 0.75,
            time_increment: 0.0625,
            scan_time: 0.25,
            range_min: 0.125,
            range_max: 30.0,
            ranges: vec![1.0, 2.5, f32::INFINITY, 0.0, 29.75],
            intensities: vec![7.0],
        }),
        RosSchema::Odometry => RosMessage::Odometry(Odometry {
            header: header("odom"),
            child_frame_id: "base_link",
            pose: POSE,
            twist: TWIST,
        }),
        RosSchema::Image => RosMessage::Image(Image {
            header: header("camera"),
            height: 2,
            width: 1,
            encoding: "bgr8",
            is_bigendian: false,
            step: 4,
            data: &[3, 2, 1, 99, 6, 5, 4, 99],
        }),
        RosSchema::CompressedImage => RosMessage::CompressedImage(CompressedImage {
            header: header("camera"),
            format: "rgb8; jpeg compressed bgr8",
            data: &[255, 216, 255, 224],
        }),
        RosSchema::CameraInfo => RosMessage::CameraInfo(CameraInfo {
            header: header("camera"),
            height: 480,
            width: 640,
            distortion_model: "plumb_bob",
            d: vec![0.5, -0.25, 0.0],
            k: std::array::from_fn(count(0.0)),
            r: std::array::from_fn(count(10.0)),
            p: std::array::from_fn(count(20.0)),
            binning: [2, 1],
            region: [4, 5, 7, 6],
        }),
        RosSchema::PoseStamped => {
            RosMessage::Pose(PoseStamped { header: header("map"), pose: POSE, covariance: None })
        }
        RosSchema::PoseWithCovarianceStamped => {
            let covariance = Some([0.0, 1.0, 5.0, 6.0, 7.0, 11.0, 30.0, 31.0, 35.0]);
            RosMessage::Pose(PoseStamped { header: header("map"), pose: POSE, covariance })
        }
        RosSchema::TwistStamped => {
            RosMessage::Twist(TwistStamped { header: Some(header("base_link")), twist: TWIST })
        }
        RosSchema::Twist => RosMessage::Twist(TwistStamped { header: None, twist: TWIST }),
        RosSchema::Transforms => {
            RosMessage::Transforms(vec![transform("odom", "base_link"), transform("base_link", "a")])
        }
        other => panic!("{other:?} has no golden message"),
    }
}

#[test]
fn every_message_reads_as_it_was_written_in_both_byte_orders() {
    for (schema, bytes) in golden() {
        assert_eq!(schema.decode(&bytes), Ok(expected(schema)), "{schema:?}");
    }
}

#[test]
fn a_message_cut_anywhere_is_an_error_that_says_where() {
    for (schema, bytes) in golden() {
        for n_bytes in 0..bytes.len() {
            let error = schema.decode(&bytes[..n_bytes]).unwrap_err();
            match error {
                CdrError::NoHeader { n_bytes: told } => assert!(n_bytes < 4 && told == n_bytes),
                CdrError::Truncated { at, needed, left } => {
                    assert!(needed > left as u64 && (left == 0 || at + left + 4 == n_bytes), "{error}");
                }
                other => panic!("{schema:?} cut after {n_bytes} bytes: {other}"),
            }
        }
    }
}

/// What a message holds beside itself cannot be larger than the bytes that it came in, but for the memory that a transform takes more than
/// its 72 bytes or more.
fn is_within(message: &RosMessage<'_>, n_bytes: usize) -> bool {
    let held = match message {
        RosMessage::LaserScan(scan) => 4 * (scan.ranges.capacity() + scan.intensities.capacity()),
        RosMessage::CameraInfo(info) => 8 * info.d.capacity(),
        RosMessage::Transforms(transforms) => 72 * transforms.len(),
        _ => 0,
    };
    held <= n_bytes
}

#[test]
fn every_byte_may_be_any_other() {
    for (schema, bytes) in golden() {
        for at in 0..bytes.len() {
            for value in 0..=u8::MAX {
                let mut damaged = bytes.clone();
                damaged[at] = value;
                if let Ok(message) = schema.decode(&damaged) {
                    assert!(is_within(&message, damaged.len()), "{schema:?} with byte {at} set to {value}");
                }
            }
        }
    }
}

fn header_strategy() -> impl Strategy<Value = (i32, u32, String)> {
    (any::<i32>(), any::<u32>(), ".{0,9}")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn scans_that_are_encoded_by_the_specification_come_back(
        (sec, nanosec, frame_id) in header_strategy(),
        numbers in prop::array::uniform7(-1e6..1e6_f32),
        ranges in prop::collection::vec(0.0..1e6_f32, 0..20),
        intensities in prop::collection::vec(0.0..1e6_f32, 0..20),
        is_little_endian: bool,
    ) {
        let mut cdr = Encoder::new(is_little_endian);
        cdr.header(sec, nanosec, &frame_id);
        numbers.iter().for_each(|number| cdr.f32(*number));
        cdr.f32s(&ranges);
        cdr.f32s(&intensities);
        let [angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max] = numbers;
        let header = Header { sec, nanosec, frame_id: &frame_id };
        let scan = LaserScan {
            header, angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max, ranges,
            intensities,
        };
        let bytes = cdr.finish();
        prop_assert_eq!(RosSchema::LaserScan.decode(&bytes), Ok(RosMessage::LaserScan(scan)));
    }

    #[test]
    fn images_that_are_encoded_by_the_specification_come_back(
        (sec, nanosec, frame_id) in header_strategy(),
        (height, width, step) in any::<(u32, u32, u32)>(),
        (encoding, is_bigendian) in (".{0,9}", any::<bool>()),
        data in prop::collection::vec(any::<u8>(), 0..40),
        is_little_endian: bool,
    ) {
        let mut cdr = Encoder::new(is_little_endian);
        cdr.header(sec, nanosec, &frame_id);
        cdr.u32(height);
        cdr.u32(width);
        cdr.string(&encoding);
        cdr.u8(is_bigendian.into());
        cdr.u32(step);
        cdr.bytes(&data);
        let header = Header { sec, nanosec, frame_id: &frame_id };
        let image = Image { header, height, width, encoding: &encoding, is_bigendian, step, data: &data };
        let bytes = cdr.finish();
        prop_assert_eq!(RosSchema::Image.decode(&bytes), Ok(RosMessage::Image(image)));
    }

    #[test]
    fn transforms_that_are_encoded_by_the_specification_come_back(
        frames in prop::collection::vec((header_strategy(), ".{0,9}", prop::array::uniform7(-1e6..1e6_f64)), 0..5),
        is_little_endian: bool,
    ) {
        let mut cdr = Encoder::new(is_little_endian);
        cdr.u32(frames.len() as u32);
        for ((sec, nanosec, parent), child, numbers) in &frames {
            cdr.header(*sec, *nanosec, parent);
            cdr.string(child);
            numbers.iter().for_each(|number| cdr.f64(*number));
        }
        let expected = frames.iter().map(|((sec, nanosec, parent), child, [x, y, z, qx, qy, qz, qw])| TransformStamped {
            header: Header { sec: *sec, nanosec: *nanosec, frame_id: parent },
            child_frame_id: child,
            transform: Pose { position: [*x, *y, *z], orientation: [*qx, *qy, *qz, *qw] },
        });
        let bytes = cdr.finish();
        prop_assert_eq!(RosSchema::Transforms.decode(&bytes), Ok(RosMessage::Transforms(expected.collect())));
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), plain: bool) {
        let with_header = if plain { [&[0, 1, 0, 0], &bytes[..]].concat() } else { bytes };
        for (schema, _) in golden() {
            if let Ok(message) = schema.decode(&with_header) {
                prop_assert!(is_within(&message, with_header.len()));
            }
        }
    }
}
