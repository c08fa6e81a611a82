use nalgebra::Vector2;
use wayfix_estimation_traits::{Pose2, Pose3};

use crate::{AckermannDrive, EncodedImage, LaserScan, PoseMeasurement, Stamp};

/// A stamped datum.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Time of the event, on the clock of the log.
    pub stamp: Stamp,
    /// The datum.
    pub data: RecordData,
}

/// Content of a record. SI units and radians, REP 103 axes.
///
/// New sensors will add kinds; match with a wildcard arm.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RecordData {
    /// Body velocity; it holds until the next one.
    Velocity(Velocity),
    /// Motion since the previous increment, in the robot frame before the motion.
    OdometryIncrement(Pose2<f64>),
    /// Command or measurement of a car-like vehicle; it holds until the next one.
    Ackermann(AckermannDrive),
    /// All detections of one scan of a range-bearing sensor, in log order.
    Detections(Vec<Detection>),
    /// Widths of the objects detected at the same stamp, in the same order, m. This record precedes the detections.
    DetectionWidths(Vec<f64>),
    /// One scan of a laser.
    Scan(LaserScan),
    /// Pose of the laser in the robot frame: its bearing 0 is along its x axis. It holds until the next one; the default is the centre.
    LaserMount(Pose2<f64>),
    /// True pose of the robot, from motion capture or a simulator.
    TruePose(Pose2<f64>),
    /// True position of one point of the robot, for example from a satellite receiver; the heading is unknown.
    TruePosition(TruePosition),
    /// True position of a landmark.
    TrueLandmark(TrueLandmark),
    /// True position of a wall.
    TrueWall(TrueWall),
    /// Measurement of the pose, or a part of it, by a sensor that does not use the map.
    PoseMeasurement(PoseMeasurement),
    /// A pose some program estimated.
    EstimatedPose(Pose2<f64>),
    /// Calibration of the camera; it holds until the next one.
    CameraInfo(CameraInfo),
    /// Pose of the camera in the robot frame on the ground, from the joint angles: x along the optical axis, y left, z up.
    CameraMount(Pose3<f64>),
    /// A camera image.
    Image(EncodedImage),
    /// Label of each pixel of the image at the same stamp: 0 for background, k + 1 for map colour k.
    TrueLabels(EncodedImage),
}

impl RecordData {
    /// The kind of record, in words.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Velocity(_) => "velocity",
            Self::OdometryIncrement(_) => "odometry increment",
            Self::Ackermann(_) => "ackermann drive",
            Self::Detections(_) => "detections",
            Self::DetectionWidths(_) => "detection widths",
            Self::Scan(_) => "laser scan",
            Self::LaserMount(_) => "laser mount",
            Self::TruePose(_) => "true pose",
            Self::TruePosition(_) => "true position",
            Self::TrueLandmark(_) => "true landmark",
            Self::TrueWall(_) => "true wall",
            Self::PoseMeasurement(_) => "pose measurement",
            Self::EstimatedPose(_) => "estimated pose",
            Self::CameraInfo(_) => "camera info",
            Self::CameraMount(_) => "camera mount",
            Self::Image(_) => "image",
            Self::TrueLabels(_) => "true labels",
        }
    }

    /// Returns the kind if one of its numbers is NaN or infinite where that is not allowed.
    pub(crate) fn check_finite(&self) -> Result<(), &'static str> {
        let is_finite = match self {
            Self::Velocity(velocity) => velocity.linear.is_finite() && velocity.angular.is_finite(),
            Self::OdometryIncrement(pose)
            | Self::LaserMount(pose)
            | Self::TruePose(pose)
            | Self::EstimatedPose(pose) => pose.is_finite(),
            Self::Ackermann(drive) => drive.wheel_speed.is_finite() && drive.steering.is_finite(),
            Self::Detections(detections) => {
                detections.iter().all(|s| s.range.is_finite() && s.bearing.is_finite())
            }
            Self::DetectionWidths(widths) => widths.iter().all(|width| width.is_finite()),
            Self::Scan(scan) => scan.has_finite_angles(),
            Self::TruePosition(position) => position.x.is_finite() && position.y.is_finite(),
            Self::TrueLandmark(landmark) => landmark.x.is_finite() && landmark.y.is_finite(),
            Self::TrueWall(wall) => wall.start.iter().chain(wall.end.iter()).all(|v| v.is_finite()),
            Self::PoseMeasurement(measurement) => measurement.is_finite(),
            Self::CameraInfo(info) => [info.fx, info.fy, info.cx, info.cy].iter().all(|v| v.is_finite()),
            Self::CameraMount(pose) => {
                pose.translation.iter().chain(pose.rotation.coords.iter()).all(|v| v.is_finite())
            }
            Self::Image(_) | Self::TrueLabels(_) => true,
        };
        if is_finite { Ok(()) } else { Err(self.kind()) }
    }
}

/// Planar body velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// Forward, m/s.
    pub linear: f64,
    /// Counter-clockwise, rad/s.
    pub angular: f64,
}

/// A pinhole camera. With the camera's x axis along the optical axis, y left, z up, a point is at column $`c_x - f_x y / x`$ and row
/// $`c_y - f_y z / x`$; pixel (i, j) covers [i, i + 1) × [j, j + 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraInfo {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Horizontal focal length, pixels.
    pub fx: f64,
    /// Vertical focal length, pixels.
    pub fy: f64,
    /// Column of the optical axis, pixels.
    pub cx: f64,
    /// Row of the optical axis, pixels.
    pub cy: f64,
}

impl CameraInfo {
    /// Whether it has pixels and both focal lengths are positive.
    pub(crate) fn sees(&self) -> bool {
        self.width > 0 && self.height > 0 && self.fx > 0.0 && self.fy > 0.0
    }
}

/// One range and bearing to one thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Identity reported by the sensor.
    pub target: DetectionTarget,
    /// Distance, metres.
    pub range: f64,
    /// Direction from the sensor, radians, 0 ahead (along the robot's x axis), counter-clockwise.
    pub bearing: f64,
}

/// Target of a detection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum DetectionTarget {
    /// A landmark with an identity read by the sensor.
    Landmark(u32),
    /// Another robot.
    Robot(u32),
    /// A code that the log's own table does not list.
    UnknownCode(u32),
    /// The sensor does not distinguish targets.
    Unlabelled,
}

/// Position of an antenna, or another point of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruePosition {
    /// x in the world, metres.
    pub x: f64,
    /// y in the world, metres.
    pub y: f64,
}

/// A surveyed landmark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueLandmark {
    /// Its identity.
    pub id: u32,
    /// x in the world, metres.
    pub x: f64,
    /// y in the world, metres.
    pub y: f64,
}

/// A surveyed wall, or another straight surface visible to a laser. The order of the ends does not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueWall {
    /// Its identity.
    pub id: u32,
    /// One end in the world, metres.
    pub start: Vector2<f64>,
    /// The other end, metres.
    pub end: Vector2<f64>,
}
