use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use foxglove::Encode;
use foxglove::messages::{FrameTransform, PosesInFrame};
use mcap::WriteOptions;
use mcap::records::MessageHeader;
use wayfix_estimation_traits::Pose2;

use super::drawing::scene_update;
use super::{Drawing, encode, origin, topics};
use super::{camera, vehicle};
use crate::{Data, Format, LogError, Record, Stamp, TrueLandmark};

/// Messages are flushed in chunks of about this size: a crash loses no more.
const CHUNK_BYTES: u64 = 256 << 10;

/// Writes records and things to draw into an MCAP file that Foxglove and Rerun open.
///
/// The same calls give the same bytes: no compression, no clock, no library version. [`finish`](Self::finish) completes the file.
///
/// ```
/// use std::io::Cursor;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{Data, McapWriter, Record, Stamp};
/// let mut file = Cursor::new(Vec::new());
/// let mut writer = McapWriter::new(&mut file)?;
/// writer.record(&Record { stamp: Stamp::from_nanoseconds(5), data: Data::TruePose(Pose2::new(1.0, 2.0, 0.5)) })?;
/// writer.poses_in_frame("/path", Stamp::from_nanoseconds(5), "world", &[Pose2::new(1.0, 2.0, 0.5)])?;
/// writer.finish()?;
/// assert!(file.into_inner().starts_with(b"\x89MCAP0\r\n"));
/// # Ok::<(), wayfix_sensor_log::LogError>(())
/// ```
pub struct McapWriter<W: Write + Seek> {
    writer: mcap::Writer<W>,
    channels: BTreeMap<(String, String), Channel>,
    /// Landmarks in a row at one stamp become one cloud, so that viewers draw them together.
    landmarks: Vec<TrueLandmark>,
    landmarks_stamp: Stamp,
}

struct Channel {
    id: u16,
    sequence: u32,
}

impl McapWriter<BufWriter<File>> {
    /// Creates the file, or replaces the one that is there.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, LogError> {
        let path = path.as_ref();
        let file = File::create(path).map_err(|source| LogError::NotCreated { path: path.into(), source })?;
        Self::new(BufWriter::new(file))
    }
}

impl<W: Write + Seek> McapWriter<W> {
    /// Writes to `out`.
    ///
    /// # Errors
    /// When `out` fails.
    pub fn new(out: W) -> Result<Self, LogError> {
        let writer = WriteOptions::new()
            .compression(None)
            .library("wayfix")
            .chunk_size(Some(CHUNK_BYTES))
            .create(out)?;
        Ok(Self {
            writer,
            channels: BTreeMap::new(),
            landmarks: Vec::new(),
            landmarks_stamp: Stamp::default(),
        })
    }

    /// Says which format the records come from; reading gives it back as [`LogMeta::origin`](crate::LogMeta::origin).
    ///
    /// Call it before anything else is written: readers that stream meet it in time only there. MCAP as the origin leaves no trace,
    /// since the file itself says so.
    ///
    /// # Errors
    /// When the output fails.
    pub fn origin(&mut self, origin: Format) -> Result<(), LogError> {
        if origin != Format::Mcap {
            self.writer.write_metadata(&origin::encode(origin))?;
        }
        Ok(())
    }

    /// Writes a record to the topic of its kind (see [`topics`]); reading gives it back to the bit (negative zeros lose their sign).
    ///
    /// # Errors
    /// When a number is not finite, a camera has no pixels or no focal length, an image is not of the format that it says, the stamp
    /// is beyond the year 2106, or the output fails.
    pub fn record(&mut self, record: &Record) -> Result<(), LogError> {
        let stamp = record.stamp;
        record.data.check_finite().map_err(|what| LogError::NotFinite { what, stamp })?;
        camera::check(record)?;
        if let Data::TrueLandmark(landmark) = record.data {
            if stamp != self.landmarks_stamp {
                self.flush_landmarks()?;
                self.landmarks_stamp = stamp;
            }
            self.landmarks.push(landmark);
            return Ok(());
        }
        self.flush_landmarks()?;
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
            Data::SightedWidths(widths) => {
                self.message(topics::SIGHTED_WIDTHS, stamp, &vehicle::encode_widths(timestamp, widths))
            }
            Data::TruePosition(position) => {
                self.message(topics::TRUE_POSITION, stamp, &vehicle::encode_position(timestamp, position))
            }
            Data::Sightings(look) => {
                self.message(topics::SIGHTINGS, stamp, &encode::sightings(timestamp, look))
            }
            Data::TruePose(pose) => self.pose_in_frame(topics::TRUE_POSE, stamp, topics::WORLD_FRAME, pose),
            Data::EstimatedPose(pose) => {
                self.pose_in_frame(topics::ESTIMATED_POSE, stamp, topics::WORLD_FRAME, pose)
            }
            Data::TrueLandmark(_) => Ok(()),
            Data::CameraInfo(info) => {
                self.message(topics::CAMERA_INFO, stamp, &camera::encode_info(timestamp, info))
            }
            Data::CameraMount(pose) => {
                self.message(topics::CAMERA_MOUNT, stamp, &camera::encode_mount(timestamp, pose))?;
                self.message(topics::CAMERA_OPTICAL, stamp, &camera::encode_optical(timestamp))
            }
            Data::Image(image) => self.message(topics::IMAGE, stamp, &camera::encode_image(timestamp, image)),
            Data::TrueLabels(image) => {
                self.message(topics::TRUE_LABELS, stamp, &camera::encode_image(timestamp, image))
            }
        }
    }

    /// A pose in `frame`, as `foxglove.PoseInFrame`.
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn pose_in_frame(
        &mut self,
        topic: &str,
        stamp: Stamp,
        frame: &str,
        pose: &Pose2<f64>,
    ) -> Result<(), LogError> {
        let message = encode::pose_in_frame(encode::timestamp(stamp)?, frame, pose);
        self.message(topic, stamp, &message)
    }

    /// Where the frame `child` is in the frame `parent`, as `foxglove.FrameTransform`; viewers need it to place what is given in `child`.
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn frame_transform(
        &mut self,
        topic: &str,
        stamp: Stamp,
        parent: &str,
        child: &str,
        pose: &Pose2<f64>,
    ) -> Result<(), LogError> {
        let message = FrameTransform {
            timestamp: Some(encode::timestamp(stamp)?),
            parent_frame_id: parent.to_owned(),
            child_frame_id: child.to_owned(),
            translation: Some(encode::position(pose)),
            rotation: Some(encode::orientation(pose)),
        };
        self.message(topic, stamp, &message)
    }

    /// A path, as `foxglove.PosesInFrame`.
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn poses_in_frame(
        &mut self,
        topic: &str,
        stamp: Stamp,
        frame: &str,
        poses: &[Pose2<f64>],
    ) -> Result<(), LogError> {
        let message = PosesInFrame {
            timestamp: Some(encode::timestamp(stamp)?),
            frame_id: frame.to_owned(),
            poses: poses.iter().map(encode::pose).collect(),
        };
        self.message(topic, stamp, &message)
    }

    /// Points in the plane, as `foxglove.PointCloud`.
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn point_cloud(
        &mut self,
        topic: &str,
        stamp: Stamp,
        frame: &str,
        points: &[[f64; 2]],
    ) -> Result<(), LogError> {
        let message = encode::points(encode::timestamp(stamp)?, frame, points);
        self.message(topic, stamp, &message)
    }

    /// Ellipses, paths and markers, as `foxglove.SceneUpdate` (Foxglove draws them, Rerun 0.41 does not).
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn scene_update(
        &mut self,
        topic: &str,
        stamp: Stamp,
        frame: &str,
        drawings: &[Drawing],
    ) -> Result<(), LogError> {
        let message = scene_update(encode::timestamp(stamp)?, frame, drawings);
        self.message(topic, stamp, &message)
    }

    /// Completes the file with its index.
    ///
    /// # Errors
    /// When the output fails.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.flush_landmarks()?;
        self.writer.finish()?;
        self.writer.into_inner().flush().map_err(mcap::McapError::from)?;
        Ok(())
    }

    fn flush_landmarks(&mut self) -> Result<(), LogError> {
        if self.landmarks.is_empty() {
            return Ok(());
        }
        let landmarks = std::mem::take(&mut self.landmarks);
        let message = encode::landmarks(encode::timestamp(self.landmarks_stamp)?, &landmarks);
        self.message(topics::TRUE_LANDMARKS, self.landmarks_stamp, &message)
    }

    fn message<M>(&mut self, topic: &str, stamp: Stamp, message: &M) -> Result<(), LogError>
    where
        M: Encode + prost::Message,
    {
        let schema = M::get_schema().expect("invariant: every Foxglove message has a schema");
        let channel = match self.channels.entry((topic.to_owned(), schema.name.clone())) {
            std::collections::btree_map::Entry::Occupied(entry) => entry.into_mut(),
            std::collections::btree_map::Entry::Vacant(entry) => {
                let schema_id = self.writer.add_schema(&schema.name, &schema.encoding, &schema.data)?;
                let id = self.writer.add_channel(schema_id, topic, "protobuf", &BTreeMap::new())?;
                entry.insert(Channel { id, sequence: 0 })
            }
        };
        let time = stamp.nanoseconds();
        let header = MessageHeader {
            channel_id: channel.id,
            sequence: channel.sequence,
            log_time: time,
            publish_time: time,
        };
        channel.sequence = channel.sequence.wrapping_add(1);
        self.writer.write_to_known_channel(&header, &message.encode_to_vec())?;
        Ok(())
    }
}
