//! Car odometry, bare positions and widths as Foxglove messages, and back.

use foxglove::messages::packed_element_field::NumericType::{Float32, Float64};
use foxglove::messages::{JointState, JointStates, PointCloud, Timestamp};

use super::cloud::{self, Column};
use super::reading::decode::{decode, point_fields, read_points, stamp};
use super::{topics, writing::encode};
use crate::fault::{Fault, finite, inconsistent};
use crate::{AckermannDrive, Record, RecordData, Stamp, TruePosition};

const WHEEL: &str = "wheel";
const STEERING: &str = "steering";

/// A viewer takes a cloud without coordinates for a broken one.
const WIDTH_COLUMNS: [Column; 4] = [("width", Float64), ("x", Float32), ("y", Float32), ("z", Float32)];

pub(super) fn encode_drive(timestamp: Timestamp, drive: &AckermannDrive) -> JointStates {
    let joint = |name: &str| JointState { name: name.to_owned(), ..JointState::default() };
    let wheel = JointState { velocity: Some(drive.wheel_speed), ..joint(WHEEL) };
    let steering = JointState { position: Some(drive.steering), ..joint(STEERING) };
    JointStates { timestamp: Some(timestamp), joints: vec![wheel, steering] }
}

pub(super) fn drive(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let message: JointStates = decode(bytes)?;
    let joint = |name: &str| message.joints.iter().find(|joint| joint.name == name);
    let wheel_speed = joint(WHEEL).and_then(|joint| joint.velocity);
    let steering = joint(STEERING).and_then(|joint| joint.position);
    let (Some(wheel_speed), Some(steering)) = (wheel_speed, steering) else {
        return Err(inconsistent("joints without the velocity of \"wheel\" or the position of \"steering\""));
    };
    finite([wheel_speed, steering])?;
    let data = RecordData::Ackermann(AckermannDrive { wheel_speed, steering });
    Ok(vec![Record { stamp: stamp(message.timestamp, log_time)?, data }])
}

pub(super) fn encode_position(timestamp: Timestamp, position: &TruePosition) -> PointCloud {
    encode::points(timestamp, topics::WORLD_FRAME, &[[position.x, position.y]])
}

pub(super) fn position(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let cloud: PointCloud = decode(bytes)?;
    let stamp = stamp(cloud.timestamp, log_time)?;
    let [x, y] = point_fields(&cloud, ["x", "y"])?;
    let positions =
        read_points(&cloud, |point| Some(TruePosition { x: x.float(point)?, y: y.float(point)? }))?;
    finite(positions.iter().flat_map(|position| [position.x, position.y]))?;
    let to_record = |position| Record { stamp, data: RecordData::TruePosition(position) };
    Ok(positions.into_iter().map(to_record).collect())
}

pub(super) fn encode_widths(timestamp: Timestamp, widths: &[f64]) -> PointCloud {
    cloud::pack(timestamp, topics::BODY_FRAME, &WIDTH_COLUMNS, widths, |width, data| {
        data.extend(width.to_le_bytes());
        data.extend([0; 12]); // x, y and z
    })
}

pub(super) fn widths(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let cloud: PointCloud = decode(bytes)?;
    let [width] = point_fields(&cloud, ["width"])?;
    let widths = read_points(&cloud, |point| width.float(point))?;
    finite(widths.iter().copied())?;
    Ok(vec![Record { stamp: stamp(cloud.timestamp, log_time)?, data: RecordData::DetectionWidths(widths) }])
}
