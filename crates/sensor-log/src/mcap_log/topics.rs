//! Topic and Foxglove schema of each kind of record in an MCAP file.
//! | topic | schema | frame | record |
//! | --- | --- | --- | --- |
//! | [`VELOCITY`] | `foxglove.Odometry`, the two velocities | [`BODY_FRAME`] in [`ODOMETRY_FRAME`] | [`RecordData::Velocity`](crate::RecordData::Velocity) |
//! | [`INCREMENT`] | `foxglove.PoseInFrame`, new pose in the old body frame | [`BODY_FRAME`] | [`RecordData::OdometryIncrement`](crate::RecordData::OdometryIncrement) |
//! | [`ACKERMANN`] | `foxglove.JointStates`, velocity of `wheel`, position of `steering` | | [`RecordData::Ackermann`](crate::RecordData::Ackermann) |
//! | [`DETECTIONS`] | `foxglove.PointCloud` with `range`, `bearing`, `x`, `y`, `z`, `kind`, `id` | [`BODY_FRAME`] | [`RecordData::Detections`](crate::RecordData::Detections) |
//! | [`DETECTION_WIDTHS`] | `foxglove.PointCloud` with `width`, `x`, `y`, `z` | [`BODY_FRAME`] | [`RecordData::DetectionWidths`](crate::RecordData::DetectionWidths) |
//! | [`SCAN`] | `foxglove.LaserScan`; `angle_increment`, `range_max` and, where it is known, `beam_period` in the metadata of the channel | [`BODY_FRAME`] | [`RecordData::Scan`](crate::RecordData::Scan) |
//! | [`LASER_MOUNT`] | `foxglove.FrameTransform` | [`LASER_FRAME`] in [`BODY_FRAME`] | [`RecordData::LaserMount`](crate::RecordData::LaserMount) |
//! | [`TRUE_POSITION`] | `foxglove.PointCloud` with `x`, `y`, `z` | [`WORLD_FRAME`] | [`RecordData::TruePosition`](crate::RecordData::TruePosition) |
//! | [`TRUE_POSE`] | `foxglove.PoseInFrame` | [`WORLD_FRAME`] | [`RecordData::TruePose`](crate::RecordData::TruePose) |
//! | [`TRUE_LANDMARKS`] | `foxglove.PointCloud` with `x`, `y`, `z`, `id` | [`WORLD_FRAME`] | [`RecordData::TrueLandmark`](crate::RecordData::TrueLandmark) |
//! | [`TRUE_WALLS`] | `foxglove.PointCloud` with `x`, `y`, `z`, `end_x`, `end_y`, `id` | [`WORLD_FRAME`] | [`RecordData::TrueWall`](crate::RecordData::TrueWall) |
//! | [`POSE_MEASUREMENT`] | `foxglove.PointCloud` with `x`, `y`, `z`, `heading`, `kind` and the covariance | any | [`RecordData::PoseMeasurement`](crate::RecordData::PoseMeasurement) |
//! | [`ESTIMATED_POSE`] | `foxglove.PoseInFrame` | [`WORLD_FRAME`] | [`RecordData::EstimatedPose`](crate::RecordData::EstimatedPose) |
//! | [`CAMERA_INFO`] | `foxglove.CameraCalibration` | [`CAMERA_OPTICAL_FRAME`] | [`RecordData::CameraInfo`](crate::RecordData::CameraInfo) |
//! | [`CAMERA_MOUNT`] | `foxglove.FrameTransform` | [`CAMERA_FRAME`] in [`BODY_FRAME`] | [`RecordData::CameraMount`](crate::RecordData::CameraMount) |
//! | [`IMAGE`] | `foxglove.CompressedImage`, JPEG or PNG, or `foxglove.RawImage` | [`CAMERA_OPTICAL_FRAME`] | [`RecordData::Image`](crate::RecordData::Image) |
//! | [`TRUE_LABELS`] | `foxglove.CompressedImage`, grey PNG | [`CAMERA_OPTICAL_FRAME`] | [`RecordData::TrueLabels`](crate::RecordData::TrueLabels) |
//!
//! With every camera mount, [`CAMERA_OPTICAL`] places the optical frame (z forward, x right, y down) that viewers draw images in.
//!
//! With every scan, [`SCAN_POINTS`] has the beams that came back as a `foxglove.PointCloud`, for viewers that draw no scans.
//!
//! [`TARGET`] has outlines that a tracker saw in the image of the same stamp, as `foxglove.ImageAnnotations`; it is not read back.
//!
//! A metadata record `wayfix` with the key `origin` names the format that the records come from, when it was another one.
//!
//! `docs/topics.md` describes the conventions, `docs/adr/0002-mcap-topics.md` gives the reasons.

/// Body velocities.
pub const VELOCITY: &str = "/odom/velocity";
/// Odometry increments.
pub const INCREMENT: &str = "/odom/increment";
/// Wheel speed and steering of a car-like vehicle.
pub const ACKERMANN: &str = "/odom/ackermann";
/// Ranges and bearings.
pub const DETECTIONS: &str = "/sightings";
/// Widths of detected objects.
pub const DETECTION_WIDTHS: &str = "/sightings/widths";
/// Laser scans.
pub const SCAN: &str = "/scan";
/// Pose of the laser on the robot.
pub const LASER_MOUNT: &str = "/scan/mount";
/// The same as points; not read back.
pub const SCAN_POINTS: &str = "/scan/points";
/// True position of a point of the robot.
pub const TRUE_POSITION: &str = "/truth/position";
/// True pose of the robot.
pub const TRUE_POSE: &str = "/truth/pose";
/// True positions of the landmarks.
pub const TRUE_LANDMARKS: &str = "/truth/landmarks";
/// True positions of the walls.
pub const TRUE_WALLS: &str = "/truth/walls";
/// Measurements of the pose by sensors that do not use the map.
pub const POSE_MEASUREMENT: &str = "/measured/pose";
/// Pose estimates of some program.
pub const ESTIMATED_POSE: &str = "/estimate/pose";

/// Calibration of the camera.
pub const CAMERA_INFO: &str = "/camera/info";
/// Pose of the camera on the robot.
pub const CAMERA_MOUNT: &str = "/camera/mount";
/// The camera's axes in the orientation that viewers expect; not read back.
pub const CAMERA_OPTICAL: &str = "/camera/optical";
/// Outlines of a target in the images; not read back.
pub const TARGET: &str = "/estimate/target";
/// Camera images.
pub const IMAGE: &str = "/camera/image";
/// Label of each pixel.
pub const TRUE_LABELS: &str = "/truth/labels";

/// The fixed frame.
pub const WORLD_FRAME: &str = "world";
/// The frame that wheel odometry drifts in.
pub const ODOMETRY_FRAME: &str = "odom";
/// The robot: x forward, y left.
pub const BODY_FRAME: &str = "base_link";
/// The laser, where a mount places it on the robot.
pub const LASER_FRAME: &str = "laser";
/// The camera: x along the optical axis, y left, z up.
pub const CAMERA_FRAME: &str = "camera";
/// The camera as images have it: z along the optical axis, x right, y down.
pub const CAMERA_OPTICAL_FRAME: &str = "camera_optical";
