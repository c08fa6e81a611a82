use super::{
    FoxgloveMessageSink, FoxgloveMessageWriter, camera, measurement, scan, topics, vehicle, writing::encode,
};
use crate::{ImageFileFormat, LogError, Record, RecordData};

impl<S: FoxgloveMessageSink> FoxgloveMessageWriter<S> {
    /// Writes a record to the topic of its kind (see [`topics`]); reading restores it to the bit (negative zeros lose their sign).
    /// # Errors
    /// Returns an error if a number is not finite, a camera has no pixels or no focal length, an image does not have its stated format, true
    /// labels are not compressed, the stamp is beyond the year 2106, or the output fails.
    pub fn record(&mut self, record: &Record) -> Result<(), LogError> {
        let stamp = record.stamp;
        record.data.check_finite().map_err(|what| LogError::NotFinite { what, stamp })?;
        camera::check(record)?;
        if let RecordData::TrueLandmark(_) | RecordData::TrueWall(_) = record.data {
            return self.hold(record);
        }
        self.flush_pending_cloud()?;
        let timestamp = encode::timestamp(stamp)?;
        match &record.data {
            RecordData::Velocity(velocity) => {
                self.message(topics::VELOCITY, stamp, &encode::velocity(timestamp, velocity))
            }
            RecordData::OdometryIncrement(step) => {
                self.pose_in_frame(topics::INCREMENT, stamp, topics::BODY_FRAME, step)
            }
            RecordData::Ackermann(drive) => {
                self.message(topics::ACKERMANN, stamp, &vehicle::encode_drive(timestamp, drive))
            }
            RecordData::DetectionWidths(widths) => {
                self.message(topics::DETECTION_WIDTHS, stamp, &vehicle::encode_widths(timestamp, widths))
            }
            RecordData::Scan(scan) => {
                let frame = self.scan_frame;
                let message = scan::encode_scan(timestamp, frame, scan);
                self.message_with(topics::SCAN, &scan::metadata(scan), stamp, &message)?;
                self.message(topics::SCAN_POINTS, stamp, &scan::encode_points(timestamp, frame, scan))
            }
            RecordData::LaserMount(pose) => {
                self.scan_frame = topics::LASER_FRAME;
                self.message(topics::LASER_MOUNT, stamp, &scan::encode_mount(timestamp, pose))
            }
            RecordData::TruePosition(position) => {
                self.message(topics::TRUE_POSITION, stamp, &vehicle::encode_position(timestamp, position))
            }
            RecordData::Detections(detections) => {
                self.message(topics::DETECTIONS, stamp, &encode::detections(timestamp, detections))
            }
            RecordData::TruePose(pose) => {
                self.pose_in_frame(topics::TRUE_POSE, stamp, topics::WORLD_FRAME, pose)
            }
            RecordData::EstimatedPose(pose) => {
                self.pose_in_frame(topics::ESTIMATED_POSE, stamp, topics::WORLD_FRAME, pose)
            }
            RecordData::PoseMeasurement(measured) => {
                self.message(topics::POSE_MEASUREMENT, stamp, &measurement::encode(timestamp, measured))
            }
            RecordData::TrueLandmark(_) | RecordData::TrueWall(_) => Ok(()),
            RecordData::CameraInfo(info) => {
                self.message(topics::CAMERA_INFO, stamp, &camera::encode_info(timestamp, info))
            }
            RecordData::CameraMount(pose) => {
                self.message(topics::CAMERA_MOUNT, stamp, &camera::encode_mount(timestamp, pose))?;
                self.message(topics::CAMERA_OPTICAL, stamp, &camera::encode_optical(timestamp))
            }
            RecordData::Image(image) if image.format == ImageFileFormat::Pnm => {
                self.message(topics::IMAGE, stamp, &camera::encode_raw_image(timestamp, image))
            }
            RecordData::Image(image) => {
                self.message(topics::IMAGE, stamp, &camera::encode_image(timestamp, image))
            }
            RecordData::TrueLabels(image) => {
                self.message(topics::TRUE_LABELS, stamp, &camera::encode_image(timestamp, image))
            }
        }
    }
}
