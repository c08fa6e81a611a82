use super::{
    CameraInfo, CompressedImage, Image, Imu, LaserScan, NavSatFix, Odometry, PoseStamped, TransformStamped,
    Twist, TwistStamped,
};
use crate::cdr::{CdrError, CdrReader, FromCdr};

/// The types of messages that are read.
///
/// ```
/// use wayfix_sensor_log::ros::{CdrError, RosMessage, RosSchema};
/// let schema = RosSchema::named("geometry_msgs/msg/Twist").expect("it is read");
/// assert_eq!(RosSchema::named("geometry_msgs/Twist"), Some(schema));
/// assert_eq!(RosSchema::named("std_msgs/msg/String"), None);
///
/// let mut bytes = vec![0, 1, 0, 0]; // plain CDR, little endian
/// bytes.extend([0.5_f64, 0.0, 0.0, 0.0, 0.0, -0.25].iter().flat_map(|number| number.to_le_bytes()));
/// let Ok(RosMessage::Twist(message)) = schema.decode(&bytes) else { unreachable!() };
/// assert_eq!((message.twist.linear[0], message.twist.angular[2]), (0.5, -0.25));
/// assert_eq!(schema.decode(&bytes[..51]), Err(CdrError::Truncated { at: 40, needed: 8, left: 7 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum RosSchema {
    /// `sensor_msgs/msg/LaserScan`
    LaserScan,
    /// `nav_msgs/msg/Odometry`
    Odometry,
    /// `sensor_msgs/msg/Image`
    Image,
    /// `sensor_msgs/msg/CompressedImage`
    CompressedImage,
    /// `sensor_msgs/msg/CameraInfo`
    CameraInfo,
    /// `geometry_msgs/msg/PoseStamped`
    PoseStamped,
    /// `geometry_msgs/msg/PoseWithCovarianceStamped`
    PoseWithCovarianceStamped,
    /// `geometry_msgs/msg/TwistStamped`
    TwistStamped,
    /// `geometry_msgs/msg/Twist`
    Twist,
    /// `sensor_msgs/msg/NavSatFix`
    NavSatFix,
    /// `sensor_msgs/msg/Imu`
    Imu,
    /// `tf2_msgs/msg/TFMessage`
    Transforms,
}

/// A message of one of them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RosMessage<'a> {
    /// A laser scan.
    LaserScan(LaserScan<'a>),
    /// Pose by wheels or another motion sensor.
    Odometry(Odometry<'a>),
    /// A camera image, as pixels.
    Image(Image<'a>),
    /// A camera image, as a file.
    CompressedImage(CompressedImage<'a>),
    /// Calibration of a camera.
    CameraInfo(CameraInfo<'a>),
    /// A pose, from a message with or without covariance.
    Pose(PoseStamped<'a>),
    /// A velocity, from a message with or without a header.
    Twist(TwistStamped<'a>),
    /// A fix of a satellite receiver.
    NavSatFix(NavSatFix<'a>),
    /// The orientation of an IMU.
    Imu(Imu<'a>),
    /// Poses of frames in other frames.
    Transforms(Vec<TransformStamped<'a>>),
}

impl RosSchema {
    /// The type of this name; `pkg/msg/Type` and `pkg/Type` are the same.
    pub fn named(name: &str) -> Option<Self> {
        let (package, rest) = name.split_once('/')?;
        match (package, rest.strip_prefix("msg/").unwrap_or(rest)) {
            ("sensor_msgs", "LaserScan") => Some(Self::LaserScan),
            ("nav_msgs", "Odometry") => Some(Self::Odometry),
            ("sensor_msgs", "Image") => Some(Self::Image),
            ("sensor_msgs", "CompressedImage") => Some(Self::CompressedImage),
            ("sensor_msgs", "CameraInfo") => Some(Self::CameraInfo),
            ("geometry_msgs", "PoseStamped") => Some(Self::PoseStamped),
            ("geometry_msgs", "PoseWithCovarianceStamped") => Some(Self::PoseWithCovarianceStamped),
            ("geometry_msgs", "TwistStamped") => Some(Self::TwistStamped),
            ("geometry_msgs", "Twist") => Some(Self::Twist),
            ("sensor_msgs", "NavSatFix") => Some(Self::NavSatFix),
            ("sensor_msgs", "Imu") => Some(Self::Imu),
            ("tf2_msgs", "TFMessage") => Some(Self::Transforms),
            _ => None,
        }
    }

    /// Decodes a message of this type.
    ///
    /// Trailing bytes are ignored, because recorders pad messages. Allocation is bounded by the bytes present, not by the lengths they claim.
    /// # Errors
    /// Returns an error if the bytes are not plain CDR or end too early.
    pub fn decode(self, bytes: &[u8]) -> Result<RosMessage<'_>, CdrError> {
        let cdr = &mut CdrReader::new(bytes)?;
        Ok(match self {
            Self::LaserScan => RosMessage::LaserScan(LaserScan::read(cdr)?),
            Self::Odometry => RosMessage::Odometry(Odometry::read(cdr)?),
            Self::Image => RosMessage::Image(Image::read(cdr)?),
            Self::CompressedImage => RosMessage::CompressedImage(CompressedImage::read(cdr)?),
            Self::CameraInfo => RosMessage::CameraInfo(CameraInfo::read(cdr)?),
            Self::PoseStamped => RosMessage::Pose(PoseStamped::read(cdr)?),
            Self::PoseWithCovarianceStamped => RosMessage::Pose(PoseStamped::read_with_covariance(cdr)?),
            Self::TwistStamped => RosMessage::Twist(TwistStamped::read(cdr)?),
            Self::Twist => RosMessage::Twist(TwistStamped { header: None, twist: Twist::read(cdr)? }),
            Self::NavSatFix => RosMessage::NavSatFix(NavSatFix::read(cdr)?),
            Self::Imu => RosMessage::Imu(Imu::read(cdr)?),
            Self::Transforms => RosMessage::Transforms(cdr.sequence()?),
        })
    }
}
