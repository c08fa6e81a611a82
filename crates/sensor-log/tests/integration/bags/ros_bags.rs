//! ROS 2 bags from beginning to end: one that the Python package rosbags wrote, and some of our own making.

use approx::assert_abs_diff_eq;
use mcap::WriteOptions;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{
    LogCompleteness, LogError, LogFormat, LogOpenOptions, LogSummary, Record, RecordData, RowProblemKind,
    TopicUse, convert, open,
};

use crate::common::bag::{
    Bag, ODOMETRY, POSE, SCAN, TRANSFORMS, odometry, odometry_with, pose, read, scan, transforms, twist,
};

const DRIVE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/ros2_drive.mcap");

fn kinds(records: &[Record]) -> Vec<&str> {
    records.iter().map(|record| record.data.kind()).collect()
}

#[test]
fn a_bag_of_rosbags_has_the_records_that_its_messages_mean() {
    let log = open(DRIVE, &LogOpenOptions::default()).unwrap();
    let uses: Vec<(String, TopicUse)> =
        log.meta().topics.iter().map(|topic| (topic.name.clone(), topic.r#use.clone())).collect();
    let expected = [
        ("/tf_static", TopicUse::Read("transforms")),
        ("/chatter", TopicUse::NotUnderstood),
        ("/odom", TopicUse::Read("odometry")),
        ("/scan", TopicUse::Read("laser scan")),
        ("/mocap/pose", TopicUse::Read("true pose")),
        ("/camera/camera_info", TopicUse::Read("camera info")),
        ("/camera/image_raw", TopicUse::Read("image")),
        ("/scan_rear", TopicUse::NotChosen("laser scan")),
    ];
    assert_eq!(uses, expected.map(|(name, r#use)| (name.to_owned(), r#use)));
    let (records, report) = log.read_all();
    assert!(report.is_clean(), "{report}");
    assert_eq!(report.ignored["/chatter (std_msgs/msg/String)"], 1);

    // The formulas of xtask/clients/ros_bags.py: a circle of 1.5 m, 1/30 rad a step, every third step.
    let angle = |index: usize| 3.0 * index as f64 / 30.0;
    let circle = |index: usize, radius: f64| {
        let angle = angle(index);
        Pose2::new(radius * angle.sin(), -radius * angle.cos(), angle)
    };
    let (mut path, mut n_truths, mut n_steps) = (circle(0, 1.05 * 1.5), 0, 0);
    for record in &records {
        match &record.data {
            RecordData::TruePose(pose) => {
                assert!(pose.inverse().compose(&circle(n_truths, 1.5)).log().norm() < 1e-12);
                n_truths += 1;
            }
            RecordData::OdometryIncrement(step) => {
                n_steps += 1;
                path = path.compose(step);
                assert!(path.inverse().compose(&circle(n_steps, 1.05 * 1.5)).log().norm() < 1e-12);
            }
            RecordData::LaserMount(mount) => {
                assert!(mount.inverse().compose(&Pose2::new(0.3, 0.0, 0.5)).log().norm() < 1e-12);
            }
            RecordData::CameraMount(mount) => {
                assert_abs_diff_eq!(
                    mount.translation,
                    nalgebra::Vector3::new(0.1, 0.0, 0.6),
                    epsilon = 1e-12
                );
                assert!(mount.rotation.angle() < 1e-12);
            }
            RecordData::CameraInfo(info) => {
                assert_eq!((info.cx, info.cy, info.fx, info.fy), (8.0, 6.0, 20.0, 21.0));
            }
            RecordData::Image(image) => {
                assert_eq!(image.decode_rgb().unwrap().pixels[16 * 3 + 3..][..2], [20, 15]);
            }
            RecordData::Scan(scan) => {
                assert_eq!((scan.ranges.len(), scan.echoes().count()), (91, 88));
                assert_eq!(scan.angle_min, f64::from((0.5 * PI) as f32)); // head down: the first beam is left
            }
            other => panic!("{}", other.kind()),
        }
    }
    assert_eq!((n_truths, n_steps, records.len()), (27, 26, 27 + 26 + 27 + 3 + 3 + 2));
}

#[test]
fn a_bag_converted_to_foxglove_reads_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("converted.mcap");
    let from_bag = open(DRIVE, &LogOpenOptions::default()).unwrap();
    let records = open(DRIVE, &LogOpenOptions::default()).unwrap().read_all().0;
    convert(from_bag, &path, LogFormat::Mcap).unwrap();
    let (back, report) = open(&path, &LogOpenOptions::default()).unwrap().read_all();
    // Scans hold NaN where nothing came back, so they are compared as they are printed.
    assert_eq!(format!("{back:?}"), format!("{records:?}"));
    assert!(report.is_clean(), "{report}");
    let text = LogSummary::of(open(&path, &LogOpenOptions::default()).unwrap()).to_string();
    assert!(text.contains("image: 3 pnm of 16 x 12 pixels"), "{text}");
}

#[test]
fn a_folder_is_the_bag_in_it_unless_there_are_several() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(DRIVE, folder.path().join("bag_0.mcap")).unwrap();
    fs::write(folder.path().join("metadata.yaml"), "rosbag2_bagfile_information:\n").unwrap();
    let log = open(folder.path(), &LogOpenOptions::default()).unwrap();
    assert_eq!(log.meta().source, folder.path().join("bag_0.mcap"));
    assert_eq!(log.count(), 88);
    fs::copy(DRIVE, folder.path().join("other.mcap")).unwrap();
    let error = open(folder.path(), &LogOpenOptions::default()).unwrap_err();
    assert!(matches!(&error, LogError::SeveralFiles { files, .. } if files.len() == 2), "{error}");
}

#[test]
fn another_laser_is_read_when_it_is_asked_for() {
    let topics = vec!["/scan_rear".to_owned()];
    let log = open(DRIVE, &LogOpenOptions { topics, ..Default::default() }).unwrap();
    let scans = log.filter(|record| matches!(record.data, RecordData::Scan(_))).count();
    assert_eq!(scans, 3);
}

#[test]
fn topics_that_cannot_be_had_are_told_with_those_that_can() {
    let bytes = fs::read(DRIVE).unwrap();
    let error = read(&bytes, &["/scna"]).unwrap_err();
    assert!(
        matches!(&error, LogError::NoSuchTopic { topic, present, .. } if topic == "/scna" && present.len() == 8)
    );
    assert!(error.to_string().contains("/scan_rear (sensor_msgs/msg/LaserScan)"), "{error}");
    let error = read(&bytes, &["/scan", "/scan_rear"]).unwrap_err();
    assert!(matches!(error, LogError::AmbiguousTopics { what: "laser scan", .. }), "{error}");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt");
    fs::write(&path, "O 1 0 0\n").unwrap();
    let options = LogOpenOptions { topics: vec!["/scan".to_owned()], ..Default::default() };
    let error = open(Path::new(&path), &options).unwrap_err();
    assert!(matches!(error, LogError::NoTopics { format: LogFormat::RangeBearing, .. }), "{error}");
}

#[test]
fn a_bag_without_an_index_is_surveyed_message_by_message() {
    let whole = fs::read(DRIVE).unwrap();
    let (records, _) = read(&whole, &["/scan_rear"]).unwrap();
    // Without the end mark there is no index to be found.
    let (again, report) = read(&whole[..whole.len() - 1], &["/scan_rear"]).unwrap();
    assert!(matches!(report.end, LogCompleteness::Truncated { missing_bytes: 1, .. }), "{report}");
    assert_eq!(format!("{again:?}"), format!("{records:?}"));
}

#[test]
fn odometry_that_only_knows_its_velocity_is_read_as_that() {
    let mut bag = Bag::new();
    for seconds in 1..4 {
        bag.put("/odom", "nav_msgs/Odometry", 0, odometry(seconds, [2.0, 0.0, 0.0], f64::from(seconds)));
    }
    let speeds: Vec<f64> = bag
        .read()
        .0
        .iter()
        .map(|record| match record.data {
            RecordData::Velocity(velocity) if velocity.angular == 0.5 => velocity.linear,
            _ => panic!("{record:?}"),
        })
        .collect();
    assert_eq!(speeds, [1.0, 2.0, 3.0]);
}

#[test]
fn odometry_of_a_standing_robot_is_increments_of_zero() {
    let mut bag = Bag::new();
    for seconds in 1..4 {
        bag.put("/odom", "nav_msgs/Odometry", 0, odometry_with(seconds, [2.0, 0.0, 0.3], [0.0; 2]));
    }
    let (records, _) = bag.read();
    assert_eq!(kinds(&records), ["odometry increment"; 2]);
    assert!(records.iter().all(|record| record.data == RecordData::OdometryIncrement(Pose2::identity())));
}

#[test]
fn motion_falls_back_to_transforms_and_then_to_velocity() {
    let mut bag = Bag::new();
    let mut still = Bag::new();
    for seconds in 1..4 {
        let x = f64::from(seconds);
        bag.put("/tf", TRANSFORMS, 0, transforms(&[(seconds, "odom", "base_link", [x, 0.0, 0.0])]));
        bag.put("/cmd_vel", "geometry_msgs/msg/Twist", seconds as u64, twist(1.0));
        still.put("/tf", TRANSFORMS, 0, transforms(&[(seconds, "base_link", "arm", [x, 0.0, 0.0])]));
        still.put("/cmd_vel", "geometry_msgs/msg/Twist", seconds as u64, twist(1.0));
    }
    let (records, report) = bag.read();
    assert_eq!(kinds(&records), ["odometry increment"; 2]);
    assert_eq!(records[0].data, RecordData::OdometryIncrement(Pose2::new(1.0, 0.0, 0.0)));
    assert_eq!(report.ignored["/cmd_vel (geometry_msgs/msg/Twist)"], 3);
    let (records, _) = still.read();
    assert_eq!(kinds(&records), ["velocity"; 3]);
    assert_eq!(records[2].stamp.nanoseconds(), 3, "what has no stamp takes the time at which it was logged");
}

#[test]
fn a_map_frame_is_an_estimate_unless_a_topic_tells_one() {
    let localized = |topic: Option<&'static str>| {
        let mut bag = Bag::new();
        for seconds in 1..3 {
            let x = f64::from(seconds);
            let frames = [
                (seconds, "map", "odom", [0.0, 10.0, 0.5 * PI]),
                (seconds, "odom", "base_link", [x, 0.0, 0.0]),
            ];
            bag.put("/tf", TRANSFORMS, 0, transforms(&frames));
            if let Some(topic) = topic {
                bag.put(topic, POSE, 0, pose(seconds, [7.0, 7.0, 0.0]));
            }
        }
        bag.read().0
    };
    let estimates: Vec<Pose2<f64>> = localized(None)
        .iter()
        .filter_map(|record| match record.data {
            RecordData::EstimatedPose(pose) => Some(pose),
            _ => None,
        })
        .collect();
    // Odometry is turned by a right angle: what went along x comes along y.
    let expected = [11.0, 12.0].map(|y| Pose2::new(0.0, y, 0.5 * PI));
    assert_eq!(estimates.len(), 2);
    for (estimate, expected) in estimates.iter().zip(&expected) {
        assert!(estimate.inverse().compose(expected).log().norm() < 1e-12, "{estimate:?}");
    }
    assert_eq!(
        kinds(&localized(Some("/amcl_pose"))),
        ["estimated pose", "odometry increment", "estimated pose"]
    );
    let with_truth = localized(Some("/vicon/robot"));
    let n_true = with_truth.iter().filter(|record| matches!(record.data, RecordData::TruePose(_))).count();
    assert_eq!((n_true, with_truth.len()), (2, 5), "truth does not replace the estimates");
}

#[test]
fn damaged_messages_are_told_and_the_rest_of_the_bag_is_read() {
    let mut bag = Bag::new();
    let whole = scan(1, &[1.0, 2.0]).finish();
    bag.put_bytes("/scan", SCAN, 0, &whole);
    bag.put_bytes("/scan", SCAN, 0, &whole[..whole.len() - 5]);
    bag.put_bytes("/scan", SCAN, 0, &[&[0, 7, 0, 0], &whole[4..]].concat());
    bag.put("/odom", ODOMETRY, 0, odometry(1, [0.0; 3], 0.0));
    bag.put("/odom", ODOMETRY, 0, odometry(2, [f64::NAN, 0.0, 0.0], 0.0));
    bag.put("/odom", ODOMETRY, 0, odometry(-3, [0.0; 3], 0.0));
    bag.put("/odom", ODOMETRY, 0, odometry(4, [0.5, 0.0, 0.0], 0.0));
    let (records, report) = bag.read();
    assert_eq!(kinds(&records), ["laser scan", "odometry increment"]);
    assert_eq!(records[1].data, RecordData::OdometryIncrement(Pose2::new(0.5, 0.0, 0.0)));
    let problems =
        [(RowProblemKind::NotFinite, 1), (RowProblemKind::BadStamp, 1), (RowProblemKind::Undecodable, 2)];
    assert_eq!(report.problems, BTreeMap::from(problems));
    assert!(report.examples[1].reason.contains("0x0007 is XCDR2"), "{report}");
}

#[test]
fn time_that_goes_back_is_told_as_in_every_log() {
    let mut bag = Bag::new();
    for seconds in [10, 11, 5, 12] {
        bag.put("/odom", ODOMETRY, 0, odometry(seconds, [f64::from(seconds), 0.0, 0.0], 0.0));
        bag.put("/scan", SCAN, 0, scan(seconds, &[1.0]));
    }
    let (records, report) = bag.read();
    assert!(records.is_sorted_by_key(|record| record.stamp));
    assert_eq!(report.problems, BTreeMap::from([(RowProblemKind::TooLate, 2)]), "{report}");
    let scans = records.iter().filter(|record| matches!(record.data, RecordData::Scan(_))).count();
    assert_eq!(scans, 3, "a scan that is seconds behind the ones before it is none of them");
}

#[test]
fn truncated_and_corrupted_bag_ends_without_a_panic() {
    let options = WriteOptions::new().compression(None).chunk_size(Some(700));
    let mut bag = Bag::with(options);
    for seconds in 1..6 {
        bag.put("/tf", TRANSFORMS, 0, transforms(&[(seconds, "base_link", "laser", [0.0, 0.0, 3.0])]));
        bag.put("/odom", ODOMETRY, 0, odometry(seconds, [f64::from(seconds), 0.0, 0.0], 0.0));
        bag.put("/scan", SCAN, 0, scan(seconds, &[1.0, 2.0, 3.0]));
    }
    let bytes = bag.finish();
    let whole = read(&bytes, &[]).unwrap().0;
    assert_eq!(whole.len(), 5 + 4 + 1);
    for n_bytes in (0..bytes.len()).step_by(7) {
        if let Ok((prefix, _)) = read(&bytes[..n_bytes], &[]) {
            assert!(prefix.len() <= whole.len(), "cut after {n_bytes} bytes");
        }
    }
    for at in (0..bytes.len()).step_by(3) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        if let Ok((records, _)) = read(&damaged, &[]) {
            assert!(records.is_sorted_by_key(|record| record.stamp), "byte {at}");
        }
    }
}
