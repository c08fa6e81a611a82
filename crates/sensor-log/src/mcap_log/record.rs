use super::{MessageSink, MessageWriter, camera, scan, topics, vehicle, writing::encode};
use crate::{Data, ImageFormat, LogError, Record};

impl<S: MessageSink> MessageWriter<S> {
    /// Writes a record to the topic of its kind (see [`topics`]); reading restores it to the bit (negative zeros lose their sign).
    /// # Errors
    /// Returns an error if a number is not finite, a camera has no pixels or no focal length, an image does not have its stated format, true
    /// labels are not compressed, the stamp is beyond the year 2106, or the output fails.
    pub fn record(&mut self, record: &Record) -> Result<(), LogError> {
        let stamp = record.stamp;
        record.data.check_finite().map_err(|what| LogError::NotFinite { what, stamp })?;
        camera::check(record)?;
        if let Data::TrueLandmark(_) | Data::TrueWall(_) = record.data {
            return self.hold(record);
        }
        self.flush_pending_cloud()?;
        let timestamp = encode::timestamp(stamp)?;
        match &record.data {
            Data::Velocity(velocity) => {
                self.message(topics::VELOCITY, stamp, &encode::velocity(timestamp, velocity))
            }
            Data::OdometryIncrement(step) => {
                self.pose_in_frame(topics::INCREMENT, stamp, topics::BODY_FRAME, step)
            }
            Data::Ackermann(drive) => {
                self.message(topics::ACKERMANN, stamp, &vehicle::encode_drive(timestamp, drive))
            }
            Data::DetectionWidths(widths) => {
                self.message(topics::DETECTION_WIDTHS, stamp, &vehicle::encode_widths(timestamp, widths))
            }
            Data::Scan(scan) => {
                let frame = self.scan_frame;
                let message = scan::encode_scan(timestamp, frame, scan);
                self.message_with(topics::SCAN, &scan::metadata(scan), stamp, &message)?;
                self.message(topics::SCAN_POINTS, stamp, &scan::encode_points(timestamp, frame, scan))
            }
            Data::LaserMount(pose) => {
                self.scan_frame = topics::LASER_FRAME;
                self.message(topics::LASER_MOUNT, stamp, &scan::encode_mount(timestamp, pose))
            }
            Data::TruePosition(position) => {
                self.message(topics::TRUE_POSITION, stamp, &vehicle::encode_position(timestamp, position))
            }
            Data::Detections(detections) => {
                self.message(topics::DETECTIONS, stamp, &encode::detections(timestamp, detections))
            }
            Data::TruePose(pose) => self.pose_in_frame(topics::TRUE_POSE, stamp, topics::WORLD_FRAME, pose),
            Data::EstimatedPose(pose) => {
                self.pose_in_frame(topics::ESTIMATED_POSE, stamp, topics::WORLD_FRAME, pose)
            }
            Data::TrueLandmark(_) | Data::TrueWall(_) => Ok(()),
            Data::CameraInfo(info) => {
                self.message(topics::CAMERA_INFO, stamp, &camera::encode_info(timestamp, info))
            }
            Data::CameraMount(pose) => {
                self.message(topics::CAMERA_MOUNT, stamp, &camera::encode_mount(timestamp, pose))?;
                self.message(topics::CAMERA_OPTICAL, stamp, &camera::encode_optical(timestamp))
            }
            Data::Image(image) if image.format == ImageFormat::Pnm => {
                self.message(topics::IMAGE, stamp, &camera::encode_raw_image(timestamp, image))
            }
            Data::Image(image) => self.message(topics::IMAGE, stamp, &camera::encode_image(timestamp, image)),
            Data::TrueLabels(image) => {
                self.message(topics::TRUE_LABELS, stamp, &camera::encode_image(timestamp, image))
            }
        }
    }
}
