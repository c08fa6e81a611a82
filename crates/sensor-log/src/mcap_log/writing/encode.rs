//! Records as Foxglove messages.

use foxglove::messages::packed_element_field::NumericType::{Float32, Float64, Uint32};
use foxglove::messages::{self, Odometry, PointCloud, PoseInFrame, Timestamp, Vector3};
use wayfix_estimation_traits::Pose2;

use super::super::cloud::{self, Column};
use super::super::topics;
use crate::planar::quaternion_of;
use crate::{Detection, DetectionTarget, LogError, Stamp, TrueLandmark, TrueWall, Velocity};

/// Bytes 0-15 are read back; the other columns are for viewers.
const DETECTION_COLUMNS: [Column; 7] = [
    ("range", Float64),
    ("bearing", Float64),
    ("x", Float32),
    ("y", Float32),
    ("z", Float32),
    ("kind", Uint32),
    ("id", Uint32),
];

const LANDMARK_COLUMNS: [Column; 4] = [("x", Float64), ("y", Float64), ("z", Float64), ("id", Uint32)];

/// The first three are for viewers.
const WALL_COLUMNS: [Column; 6] =
    [("x", Float64), ("y", Float64), ("z", Float64), ("end_x", Float64), ("end_y", Float64), ("id", Uint32)];

pub(in crate::mcap_log) fn timestamp(stamp: Stamp) -> Result<Timestamp, LogError> {
    const NANOSECONDS: u64 = 1_000_000_000;
    let (seconds, rest) = (stamp.nanoseconds() / NANOSECONDS, stamp.nanoseconds() % NANOSECONDS);
    u32::try_from(seconds)
        .ok()
        .and_then(|seconds| Timestamp::new_checked(seconds, rest as u32))
        .ok_or(LogError::StampTooLate { stamp })
}

pub(in crate::mcap_log) fn velocity(timestamp: Timestamp, velocity: &Velocity) -> Odometry {
    Odometry {
        timestamp: Some(timestamp),
        frame_id: topics::ODOMETRY_FRAME.to_owned(),
        body_frame_id: topics::BODY_FRAME.to_owned(),
        linear_velocity: Some(Vector3 { x: velocity.linear, ..Default::default() }),
        angular_velocity: Some(Vector3 { z: velocity.angular, ..Default::default() }),
        ..Default::default()
    }
}

pub(in crate::mcap_log) fn pose_in_frame(
    timestamp: Timestamp,
    frame: &str,
    planar: &Pose2<f64>,
) -> PoseInFrame {
    PoseInFrame { timestamp: Some(timestamp), frame_id: frame.to_owned(), pose: Some(pose(planar)) }
}

pub(in crate::mcap_log) fn pose(planar: &Pose2<f64>) -> messages::Pose {
    messages::Pose { position: Some(position(planar)), orientation: Some(orientation(planar)) }
}

/// No translation and no rotation, spelled out: Rerun takes an empty pose for a broken one.
pub(in crate::mcap_log) fn identity() -> messages::Pose {
    pose(&Pose2::new(0.0, 0.0, 0.0))
}

pub(in crate::mcap_log) fn position(planar: &Pose2<f64>) -> Vector3 {
    Vector3 { x: planar.x(), y: planar.y(), z: 0.0 }
}

pub(in crate::mcap_log) fn orientation(planar: &Pose2<f64>) -> messages::Quaternion {
    let [x, y, z, w] = quaternion_of(planar.heading());
    messages::Quaternion { x, y, z, w }
}

pub(in crate::mcap_log) fn detections(timestamp: Timestamp, detections: &[Detection]) -> PointCloud {
    cloud::pack(timestamp, topics::BODY_FRAME, &DETECTION_COLUMNS, detections, |detection, data| {
        let (sin, cos) = libm::sincos(detection.bearing);
        let (kind, id) = target_code(detection.target);
        data.extend(detection.range.to_le_bytes());
        data.extend(detection.bearing.to_le_bytes());
        data.extend(((detection.range * cos) as f32).to_le_bytes());
        data.extend(((detection.range * sin) as f32).to_le_bytes());
        data.extend(0.0_f32.to_le_bytes());
        data.extend(kind.to_le_bytes());
        data.extend(id.to_le_bytes());
    })
}

fn target_code(target: DetectionTarget) -> (u32, u32) {
    match target {
        DetectionTarget::Unlabelled => (0, 0),
        DetectionTarget::Landmark(id) => (1, id),
        DetectionTarget::Robot(id) => (2, id),
        DetectionTarget::UnknownCode(code) => (3, code),
    }
}

pub(in crate::mcap_log) fn landmarks(timestamp: Timestamp, landmarks: &[TrueLandmark]) -> PointCloud {
    cloud::pack(timestamp, topics::WORLD_FRAME, &LANDMARK_COLUMNS, landmarks, |landmark, data| {
        data.extend(landmark.x.to_le_bytes());
        data.extend(landmark.y.to_le_bytes());
        data.extend(0.0_f64.to_le_bytes());
        data.extend(landmark.id.to_le_bytes());
    })
}

pub(in crate::mcap_log) fn walls(timestamp: Timestamp, walls: &[TrueWall]) -> PointCloud {
    cloud::pack(timestamp, topics::WORLD_FRAME, &WALL_COLUMNS, walls, |wall, data| {
        for coordinate in [wall.start.x, wall.start.y, 0.0, wall.end.x, wall.end.y] {
            data.extend(coordinate.to_le_bytes());
        }
        data.extend(wall.id.to_le_bytes());
    })
}

/// Bare points in the plane.
pub(in crate::mcap_log) fn points(timestamp: Timestamp, frame: &str, points: &[[f64; 2]]) -> PointCloud {
    cloud::pack(timestamp, frame, &LANDMARK_COLUMNS[..3], points, |[x, y], data| {
        for coordinate in [*x, *y, 0.0] {
            data.extend(coordinate.to_le_bytes());
        }
    })
}
