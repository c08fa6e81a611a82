//! Foxglove messages as records.

use foxglove::messages::{self, Odometry, PointCloud, PoseInFrame, Timestamp};
use nalgebra::Vector2;
use prost::Message;
use wayfix_estimation_traits::Pose2;

use super::super::cloud::{self, PointField};
use super::super::{camera, measurement, scan, vehicle};
use super::routes::Route;
use crate::fault::{Fault, finite, inconsistent};
use crate::planar::heading_of;
use crate::{
    Detection, DetectionTarget, Record, RecordData, RowProblemKind, Stamp, TrueLandmark, TrueWall, Velocity,
};

/// The records in one message; a message without a stamp gets its log time.
pub(in crate::mcap_log) fn records(
    route: Route,
    bytes: &[u8],
    log_time: Stamp,
) -> Result<Vec<Record>, Fault> {
    match route {
        Route::Velocity => {
            let message: Odometry = decode(bytes)?;
            Ok(vec![Record { stamp: stamp(message.timestamp, log_time)?, data: velocity(&message)? }])
        }
        Route::Increment => pose_record(bytes, log_time, RecordData::OdometryIncrement),
        Route::Ackermann => vehicle::drive(bytes, log_time),
        Route::DetectionWidths => vehicle::widths(bytes, log_time),
        Route::TruePosition => vehicle::position(bytes, log_time),
        Route::TruePose => pose_record(bytes, log_time, RecordData::TruePose),
        Route::EstimatedPose => pose_record(bytes, log_time, RecordData::EstimatedPose),
        Route::PoseMeasurement => measurement::measurement(bytes, log_time),
        Route::CameraInfo => camera::info(bytes, log_time),
        Route::CameraMount => camera::mount(bytes, log_time),
        Route::CameraOptical | Route::ScanPoints => Ok(Vec::new()),
        Route::Scan(channel) => scan::scan(channel, bytes, log_time),
        Route::LaserMount => scan::mount(bytes, log_time),
        Route::RawImage => camera::raw_image(bytes, log_time),
        Route::Image => camera::image(bytes, log_time, RecordData::Image),
        Route::TrueLabels => camera::image(bytes, log_time, RecordData::TrueLabels),
        Route::Detections => {
            let cloud: PointCloud = decode(bytes)?;
            Ok(vec![Record {
                stamp: stamp(cloud.timestamp, log_time)?,
                data: RecordData::Detections(detections(&cloud)?),
            }])
        }
        Route::TrueLandmarks => {
            let cloud: PointCloud = decode(bytes)?;
            let stamp = stamp(cloud.timestamp, log_time)?;
            let to_record = |landmark| Record { stamp, data: RecordData::TrueLandmark(landmark) };
            Ok(landmarks(&cloud)?.into_iter().map(to_record).collect())
        }
        Route::TrueWalls => {
            let cloud: PointCloud = decode(bytes)?;
            let stamp = stamp(cloud.timestamp, log_time)?;
            let to_record = |wall| Record { stamp, data: RecordData::TrueWall(wall) };
            Ok(walls(&cloud)?.into_iter().map(to_record).collect())
        }
    }
}

pub(in crate::mcap_log) fn decode<M: Message + Default>(bytes: &[u8]) -> Result<M, Fault> {
    M::decode(bytes).map_err(|error| (RowProblemKind::Undecodable, error.to_string()))
}

pub(in crate::mcap_log) fn stamp(timestamp: Option<Timestamp>, log_time: Stamp) -> Result<Stamp, Fault> {
    let Some(timestamp) = timestamp else { return Ok(log_time) };
    timestamp
        .normalize()
        .map(|timestamp| Stamp::from_nanoseconds(timestamp.total_nanos()))
        .ok_or_else(|| (RowProblemKind::BadStamp, "time stamp out of range".to_owned()))
}

fn velocity(message: &Odometry) -> Result<RecordData, Fault> {
    let linear = message.linear_velocity.unwrap_or_default().x;
    let angular = message.angular_velocity.unwrap_or_default().z;
    finite([linear, angular])?;
    Ok(RecordData::Velocity(Velocity { linear, angular }))
}

fn pose_record(
    bytes: &[u8],
    log_time: Stamp,
    to_data: impl Fn(Pose2<f64>) -> RecordData,
) -> Result<Vec<Record>, Fault> {
    let message: PoseInFrame = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    let pose = message.pose.ok_or_else(|| inconsistent("message without a pose"))?;
    Ok(vec![Record { stamp, data: to_data(planar(&pose)?) }])
}

pub(in crate::mcap_log) fn planar(pose: &messages::Pose) -> Result<Pose2<f64>, Fault> {
    let position = pose.position.unwrap_or_default();
    // Most writers use a missing or zero quaternion for no rotation.
    let q = pose.orientation.unwrap_or_default();
    let heading = heading_of([q.x, q.y, q.z, q.w]);
    finite([position.x, position.y, heading])?;
    Ok(Pose2::new(position.x, position.y, heading))
}

fn detections(cloud: &PointCloud) -> Result<Vec<Detection>, Fault> {
    let [range, bearing, kind, id] = point_fields(cloud, ["range", "bearing", "kind", "id"])?;
    let read = |point: &[u8]| {
        let target = target(kind.whole(point)?, id.whole(point)?)?;
        Some(Detection { target, range: range.float(point)?, bearing: bearing.float(point)? })
    };
    let detections = read_points(cloud, read)?;
    finite(detections.iter().flat_map(|detection| [detection.range, detection.bearing]))?;
    Ok(detections)
}

fn target(kind: u32, id: u32) -> Option<DetectionTarget> {
    match kind {
        0 => Some(DetectionTarget::Unlabelled),
        1 => Some(DetectionTarget::Landmark(id)),
        2 => Some(DetectionTarget::Robot(id)),
        3 => Some(DetectionTarget::UnknownCode(id)),
        _ => None,
    }
}

fn landmarks(cloud: &PointCloud) -> Result<Vec<TrueLandmark>, Fault> {
    let [x, y, id] = point_fields(cloud, ["x", "y", "id"])?;
    let read =
        |point: &[u8]| Some(TrueLandmark { id: id.whole(point)?, x: x.float(point)?, y: y.float(point)? });
    let landmarks = read_points(cloud, read)?;
    finite(landmarks.iter().flat_map(|landmark| [landmark.x, landmark.y]))?;
    Ok(landmarks)
}

fn walls(cloud: &PointCloud) -> Result<Vec<TrueWall>, Fault> {
    let [x, y, end_x, end_y, id] = point_fields(cloud, ["x", "y", "end_x", "end_y", "id"])?;
    let read = |point: &[u8]| {
        let start = Vector2::new(x.float(point)?, y.float(point)?);
        let end = Vector2::new(end_x.float(point)?, end_y.float(point)?);
        Some(TrueWall { id: id.whole(point)?, start, end })
    };
    let walls = read_points(cloud, read)?;
    finite(walls.iter().flat_map(|wall| [wall.start.x, wall.start.y, wall.end.x, wall.end.y]))?;
    Ok(walls)
}

pub(in crate::mcap_log) fn point_fields<const N: usize>(
    cloud: &PointCloud,
    names: [&str; N],
) -> Result<[PointField; N], Fault> {
    let point_fields: Option<Vec<PointField>> =
        names.iter().map(|name| PointField::of(cloud, name)).collect();
    point_fields
        .and_then(|point_fields| point_fields.try_into().ok())
        .ok_or_else(|| inconsistent(&format!("point cloud without the fields {names:?}")))
}

pub(in crate::mcap_log) fn read_points<T>(
    cloud: &PointCloud,
    read: impl Fn(&[u8]) -> Option<T>,
) -> Result<Vec<T>, Fault> {
    cloud::points(cloud)
        .and_then(|points| points.map(read).collect())
        .ok_or_else(|| inconsistent("point cloud whose bytes do not fit its fields"))
}
