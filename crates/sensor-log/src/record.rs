use nalgebra::Vector2;
use wayfix_estimation_traits::{Pose2, Pose3};

use crate::{AckermannDrive, EncodedImage, LaserScan, Stamp};

/// One thing that happened, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// When it happened, on the clock of the log.
    pub stamp: Stamp,
    /// What happened.
    pub data: Data,
}

/// What a record holds. SI units and radians, REP 103 axes.
///
/// More kinds come with more sensors; match with a wildcard arm.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Data {
    /// Body velocity that holds until the next one.
    Velocity(Velocity),
    /// Motion since the previous increment, in the robot frame before the motion.
    OdometryIncrement(Pose2<f64>),
    /// What a car-like vehicle is told to do, or measures of itself; it holds until the next one.
    Ackermann(AckermannDrive),
    /// Everything one look of a range-bearing sensor saw, in the order of the log.
    Detections(Vec<Detection>),
    /// How wide the things are that the look at the same stamp saw, in its order, metres. It comes before the look.
    DetectionWidths(Vec<f64>),
    /// What one sweep of a laser saw.
    Scan(LaserScan),
    /// Where the laser is in the robot's frame: 0 of its bearings is along its x axis. It holds until the next one; the centre without any.
    LaserMount(Pose2<f64>),
    /// Where the robot truly was, from motion capture or a simulator.
    TruePose(Pose2<f64>),
    /// Where one point of the robot truly was, from a satellite receiver for instance; nothing is known of the heading.
    TruePosition(TruePosition),
    /// Where a landmark truly is.
    TrueLandmark(TrueLandmark),
    /// Where a wall truly is.
    TrueWall(TrueWall),
    /// A pose some program estimated.
    EstimatedPose(Pose2<f64>),
    /// How the camera projects; it holds until the next one.
    CameraInfo(CameraInfo),
    /// Where the joints say that the camera is in the robot's frame on the ground: x along the optical axis, y left, z up.
    CameraMount(Pose3<f64>),
    /// What the camera saw.
    Image(EncodedImage),
    /// What each pixel of the image at the same stamp shows: 0 nothing of the map, k + 1 the map's colour k.
    TrueLabels(EncodedImage),
}

impl Data {
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
            Self::EstimatedPose(_) => "estimated pose",
            Self::CameraInfo(_) => "camera info",
            Self::CameraMount(_) => "camera mount",
            Self::Image(_) => "image",
            Self::TrueLabels(_) => "true labels",
        }
    }

    /// The kind, when one of its numbers is NaN or infinite that has no business to be.
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
    /// What the sensor says it saw.
    pub target: Target,
    /// Distance, metres.
    pub range: f64,
    /// Direction from the sensor, radians, 0 ahead (along the robot's x axis), counter-clockwise.
    pub bearing: f64,
}

/// What a detection is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Target {
    /// A landmark whose identity the sensor reads.
    Landmark(u32),
    /// Another robot.
    Robot(u32),
    /// A code that the log's own table does not list.
    UnknownCode(u32),
    /// The sensor does not tell things apart.
    Unlabelled,
}

/// Where an antenna, or another point of the robot, was.
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

/// A surveyed wall, or another straight surface that a laser sees. Which end is the start says nothing of its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueWall {
    /// Its identity.
    pub id: u32,
    /// One end in the world, metres.
    pub start: Vector2<f64>,
    /// The other end, metres.
    pub end: Vector2<f64>,
}
