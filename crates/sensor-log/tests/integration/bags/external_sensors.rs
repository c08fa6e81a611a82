//! Satellite fixes, IMUs and cameras at the ceiling in ROS 2 bags.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a panic is the verdict of a test, in its helpers too")]

use crate::common::bag::{Bag, at, pose, quaternion, transforms};
use crate::common::cdr::Encoder;
use approx::assert_abs_diff_eq;
use wayfix_estimation_traits::{Pose2, nalgebra::Matrix3};
use wayfix_sensor_log::{MeasuredQuantity, PoseMeasurement, Record, RecordData, RowProblemKind};

const FIX: &str = "sensor_msgs/msg/NavSatFix";
const IMU: &str = "sensor_msgs/msg/Imu";
const POSE: &str = "geometry_msgs/msg/PoseWithCovarianceStamped";

fn fix(seconds: i32, status: i8, latitude: f64, covariance_type: u8) -> Encoder {
    let mut cdr = at(seconds, "antenna");
    cdr.u8(status.cast_unsigned());
    cdr.u16(1);
    cdr.f64s(&[latitude, 11.0, 500.0]);
    cdr.f64s(&[4.0, 0.5, 0.0, 0.5, 9.0, 0.0, 0.0, 0.0, 25.0]);
    cdr.u8(covariance_type);
    cdr
}

fn imu(seconds: i32, heading: f64, covariance: [f64; 9]) -> Encoder {
    let mut cdr = at(seconds, "imu");
    cdr.f64s(&quaternion(heading));
    cdr.f64s(&covariance);
    cdr.f64s(&[0.0; 24]);
    cdr
}

fn seen_pose(seconds: i32, covariance: [f64; 36]) -> Encoder {
    let mut cdr = pose(seconds, [1.0, 2.0, 0.5]);
    cdr.f64s(&covariance);
    cdr
}

fn measured(records: &[Record]) -> Vec<&PoseMeasurement> {
    records
        .iter()
        .filter_map(|record| match &record.data {
            RecordData::PoseMeasurement(measured) => Some(measured),
            _ => None,
        })
        .collect()
}

#[test]
fn fixes_come_with_the_covariance_that_they_state() {
    let mut bag = Bag::new();
    for (seconds, status, latitude, known) in
        [(1, 0, 48.0, 2), (2, 0, 48.0, 0), (3, -1, 48.0, 2), (4, 0, 148.0, 2), (5, 0, f64::NAN, 2)]
    {
        bag.put("/fix", FIX, seconds as u64, fix(seconds, status, latitude, known));
    }
    let (records, report) = bag.read();
    let measured = measured(&records);
    assert_eq!(measured.len(), 2);
    assert_eq!(measured[0].quantity, MeasuredQuantity::Geodetic { latitude: 48.0, longitude: 11.0 });
    let stated = Matrix3::new(4.0, 0.5, 0.0, 0.5, 9.0, 0.0, 0.0, 0.0, 0.0);
    assert_eq!(measured[0].covariance, Some(stated));
    assert_eq!(measured[1].covariance, None, "its type says that it is unknown");
    assert_eq!(report.problems.get(&RowProblemKind::Inconsistent), Some(&2), "no fix; beyond the pole");
    assert_eq!(report.problems.get(&RowProblemKind::NotFinite), Some(&1));
}

#[test]
fn an_imu_tells_the_heading_of_the_robot_it_is_mounted_on() {
    let mut bag = Bag::new();
    bag.put(
        "/tf_static",
        "tf2_msgs/msg/TFMessage",
        0,
        transforms(&[(0, "base_link", "imu", [0.0, 0.0, 1.5])]),
    );
    let known = [0.1, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.04];
    bag.put("/imu/data", IMU, 1, imu(1, 2.0, known));
    bag.put("/imu/data", IMU, 2, imu(2, 2.0, [0.0; 9]));
    bag.put("/imu/data", IMU, 3, imu(3, 2.0, [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let (records, report) = bag.read();
    let measured = measured(&records);
    let [first, second] = measured[..] else { panic!("{measured:?}") };
    let MeasuredQuantity::Heading(heading) = first.quantity else { panic!("{first:?}") };
    assert_abs_diff_eq!(heading, 0.5, epsilon = 1e-12);
    assert_eq!((first.frame.as_str(), first.covariance.unwrap().m33), ("enu", 0.04));
    assert_eq!(second.covariance, None);
    assert_eq!(report.problems.get(&RowProblemKind::Inconsistent), Some(&1), "it tells no orientation");
}

#[test]
fn imu_without_a_mount_is_an_assumption_that_is_said_once() {
    let mut bag = Bag::new();
    for seconds in 1..4 {
        bag.put("/imu", IMU, seconds as u64, imu(seconds, 1.0, [0.01; 9]));
    }
    let (_, report) = bag.read();
    let said: Vec<_> = report.warnings.iter().filter(|warning| warning.name == "imu_mount_unknown").collect();
    assert_eq!(said.len(), 1);
}

#[test]
fn poses_of_a_camera_are_measured_and_those_of_programs_are_not() {
    let covariance = std::array::from_fn(|index| if index % 7 == 0 { 0.25 } else { 0.0 });
    for (topic, n_measured) in [("/ceiling_camera/robot", 1), ("/amcl_pose", 0)] {
        let mut bag = Bag::new();
        bag.put(topic, POSE, 1, seen_pose(1, covariance));
        let (records, _) = bag.read();
        let measured = measured(&records);
        assert_eq!(measured.len(), n_measured, "{topic}");
        for measured in measured {
            assert_eq!(measured.quantity, MeasuredQuantity::Pose(Pose2::new(1.0, 2.0, 0.5)));
            assert_eq!(measured.covariance, Some(Matrix3::identity() * 0.25));
            assert_eq!(measured.frame, "map");
        }
    }
}
