use super::super::scan::ScanChannel;
use super::super::topics;

const RAW_IMAGE: &str = "foxglove.RawImage";

/// Which kind of record a channel carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::mcap_log) enum Route {
    Velocity,
    Increment,
    Ackermann,
    Detections,
    DetectionWidths,
    Scan(ScanChannel),
    LaserMount,
    /// Known and skipped: the same scan as points.
    ScanPoints,
    TruePose,
    TruePosition,
    TrueLandmarks,
    TrueWalls,
    EstimatedPose,
    PoseMeasurement,
    CameraInfo,
    CameraMount,
    /// Known and skipped: the rotation is constant.
    CameraOptical,
    Image,
    RawImage,
    TrueLabels,
}

impl Route {
    /// The kind of a topic, if it has the expected schema.
    pub(in crate::mcap_log) fn of<'a>(
        topic: &str,
        schema: &str,
        encoding: &str,
        metadata: impl Iterator<Item = (&'a str, &'a str)>,
    ) -> Option<Self> {
        let (route, expected) = match topic {
            topics::VELOCITY => (Self::Velocity, "foxglove.Odometry"),
            topics::INCREMENT => (Self::Increment, "foxglove.PoseInFrame"),
            topics::ACKERMANN => (Self::Ackermann, "foxglove.JointStates"),
            topics::DETECTIONS => (Self::Detections, "foxglove.PointCloud"),
            topics::DETECTION_WIDTHS => (Self::DetectionWidths, "foxglove.PointCloud"),
            topics::SCAN => (Self::Scan(ScanChannel::of(metadata)), "foxglove.LaserScan"),
            topics::LASER_MOUNT => (Self::LaserMount, "foxglove.FrameTransform"),
            topics::SCAN_POINTS => (Self::ScanPoints, "foxglove.PointCloud"),
            topics::TRUE_POSITION => (Self::TruePosition, "foxglove.PointCloud"),
            topics::TRUE_POSE => (Self::TruePose, "foxglove.PoseInFrame"),
            topics::TRUE_LANDMARKS => (Self::TrueLandmarks, "foxglove.PointCloud"),
            topics::TRUE_WALLS => (Self::TrueWalls, "foxglove.PointCloud"),
            topics::ESTIMATED_POSE => (Self::EstimatedPose, "foxglove.PoseInFrame"),
            topics::POSE_MEASUREMENT => (Self::PoseMeasurement, "foxglove.PointCloud"),
            topics::CAMERA_INFO => (Self::CameraInfo, "foxglove.CameraCalibration"),
            topics::CAMERA_MOUNT => (Self::CameraMount, "foxglove.FrameTransform"),
            topics::CAMERA_OPTICAL => (Self::CameraOptical, "foxglove.FrameTransform"),
            topics::IMAGE if schema == RAW_IMAGE => (Self::RawImage, RAW_IMAGE),
            topics::IMAGE => (Self::Image, "foxglove.CompressedImage"),
            topics::TRUE_LABELS => (Self::TrueLabels, "foxglove.CompressedImage"),
            _ => return None,
        };
        (schema == expected && encoding == "protobuf").then_some(route)
    }
}
