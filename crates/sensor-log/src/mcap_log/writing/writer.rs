use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use foxglove::Encode;
use foxglove::messages::{FrameTransform, PosesInFrame};
use wayfix_estimation_traits::Pose2;

use super::super::reading::file::McapMessageSink;
use super::super::reading::pending_cloud::PendingCloud;
use super::super::{ImageOutline, ViewerDrawing, camera, topics};
use super::drawing::{image_annotations, scene_update};
use super::encode;
use super::sink::{FoxgloveMessage, FoxgloveMessageSink};
use crate::{EncodedImage, ImageFileFormat, LogError, LogFormat, Record, Stamp};

/// Writes records and things to draw as Foxglove messages, into a file ([`McapWriter`]) or wherever else messages can go ([`FoxgloveMessageSink`]).
pub struct FoxgloveMessageWriter<S: FoxgloveMessageSink> {
    sink: S,
    pending_cloud: PendingCloud,
    /// The laser's own once it is known where that is.
    pub(in crate::mcap_log) scan_frame: &'static str,
}

/// Writes records and drawings to an MCAP file for Foxglove and Rerun.
///
/// Equal calls give equal bytes: no compression by default, no clock, no library version. [`finish`](FoxgloveMessageWriter::finish) completes the file.
/// ```
/// use std::io::Cursor;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{RecordData, McapWriter, Record, Stamp};
/// let mut file = Cursor::new(Vec::new());
/// let mut writer = McapWriter::new(&mut file)?;
/// writer.record(&Record { stamp: Stamp::from_nanoseconds(5), data: RecordData::TruePose(Pose2::new(1.0, 2.0, 0.5)) })?;
/// writer.poses_in_frame("/path", Stamp::from_nanoseconds(5), "world", &[Pose2::new(1.0, 2.0, 0.5)])?;
/// writer.finish()?;
/// assert!(file.into_inner().starts_with(b"\x89MCAP0\r\n"));
/// # Ok::<(), wayfix_sensor_log::LogError>(())
/// ```
pub type McapWriter<W> = FoxgloveMessageWriter<McapMessageSink<W>>;

impl McapWriter<BufWriter<File>> {
    /// Creates the file, or replaces the one that is there.
    ///
    /// # Errors
    /// Returns an error if it cannot be created.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, LogError> {
        Ok(Self::into_sink(McapMessageSink::create(path)?))
    }
}

impl<W: Write + Seek> McapWriter<W> {
    /// Writes to `out`.
    ///
    /// # Errors
    /// Returns an error if `out` fails.
    pub fn new(out: W) -> Result<Self, LogError> {
        Ok(Self::into_sink(McapMessageSink::new(out)?))
    }
}

impl<S: FoxgloveMessageSink> FoxgloveMessageWriter<S> {
    /// Writes into `sink`.
    pub fn into_sink(sink: S) -> Self {
        Self { sink, pending_cloud: PendingCloud::default(), scan_frame: topics::BODY_FRAME }
    }

    /// The destination of the messages.
    pub fn sink(&self) -> &S {
        &self.sink
    }

    /// Stores the original format of the records; reading returns it as [`LogMetadata::origin`](crate::LogMetadata::origin).
    ///
    /// Call it before anything else is written, because streaming readers need it first. MCAP as the origin is not stored, because it is the format of the file.
    /// # Errors
    /// Returns an error if the output fails.
    pub fn origin(&mut self, origin: LogFormat) -> Result<(), LogError> {
        self.sink.origin(origin)
    }

    /// A pose in `frame`, as `foxglove.PoseInFrame`.
    ///
    /// # Errors
    /// Returns the errors of [`record`](Self::record).
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

    /// Writes the pose of the frame `child` in the frame `parent`, as `foxglove.FrameTransform`; viewers need it to place data given in `child`.
    /// # Errors
    /// Returns the errors of [`record`](Self::record).
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
    /// Returns the errors of [`record`](Self::record).
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
    /// Returns the errors of [`record`](Self::record).
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
    /// Returns the errors of [`record`](Self::record).
    pub fn scene_update(
        &mut self,
        topic: &str,
        stamp: Stamp,
        frame: &str,
        drawings: &[ViewerDrawing],
    ) -> Result<(), LogError> {
        let message = scene_update(encode::timestamp(stamp)?, frame, drawings);
        self.message(topic, stamp, &message)
    }

    /// Writes outlines in the image of the same stamp, as `foxglove.ImageAnnotations`; an empty list removes the previous ones.
    /// # Errors
    /// Returns the errors of [`record`](Self::record).
    pub fn image_outlines(
        &mut self,
        topic: &str,
        stamp: Stamp,
        outlines: &[ImageOutline],
    ) -> Result<(), LogError> {
        let message = image_annotations(encode::timestamp(stamp)?, outlines);
        self.message(topic, stamp, &message)
    }

    /// A picture as it is stored, as `foxglove.CompressedImage`; JPEG or PNG.
    ///
    /// # Errors
    /// Returns the errors of [`record`](Self::record).
    pub fn image(&mut self, topic: &str, stamp: Stamp, image: &EncodedImage) -> Result<(), LogError> {
        if image.format == ImageFileFormat::Pnm
            || ImageFileFormat::of_bytes(&image.bytes) != Some(image.format)
        {
            let (what, n_bytes) = ("image", image.bytes.len());
            return Err(LogError::NotAnImage { what, format: image.format, n_bytes, stamp });
        }
        self.message(topic, stamp, &camera::encode_image(encode::timestamp(stamp)?, image))
    }

    /// Completes the file with its index, or any other sink of the messages.
    ///
    /// # Errors
    /// Returns an error if the output fails.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.flush_pending_cloud()?;
        Box::new(self.sink).finish()
    }

    /// Holds a landmark or a wall until another kind of record or stamp comes.
    pub(in crate::mcap_log) fn hold(&mut self, record: &Record) -> Result<(), LogError> {
        if !self.pending_cloud.is_of_same_cloud(record) {
            self.flush_pending_cloud()?;
        }
        self.pending_cloud.push(record);
        Ok(())
    }

    pub(in crate::mcap_log) fn flush_pending_cloud(&mut self) -> Result<(), LogError> {
        match std::mem::take(&mut self.pending_cloud).into_cloud()? {
            Some((topic, stamp, cloud)) => self.message(topic, stamp, &cloud),
            None => Ok(()),
        }
    }

    pub(in crate::mcap_log) fn message<M>(
        &mut self,
        topic: &str,
        stamp: Stamp,
        message: &M,
    ) -> Result<(), LogError>
    where
        M: Encode + prost::Message,
    {
        self.message_with(topic, &BTreeMap::new(), stamp, message)
    }

    /// A message on a channel with metadata; other metadata open another channel of the same topic.
    pub(in crate::mcap_log) fn message_with<M>(
        &mut self,
        topic: &str,
        metadata: &BTreeMap<String, String>,
        stamp: Stamp,
        message: &M,
    ) -> Result<(), LogError>
    where
        M: Encode + prost::Message,
    {
        let schema = M::get_schema().expect("invariant: every Foxglove message has a schema");
        self.sink.message(&FoxgloveMessage {
            topic,
            schema: &schema.name,
            descriptors: &schema.data,
            metadata,
            stamp,
            data: &message.encode_to_vec(),
        })
    }
}
