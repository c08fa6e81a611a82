use std::path::Path;

use wayfix_sensor_log::{Data, Format, LogError, McapFile, MessageWriter, Record, Sinks, topics};

/// What estimates are drawn with, wherever they go.
pub type EstimateWriter = MessageWriter<Sinks>;

/// Poses in the log that another program estimated, beside those of ours.
pub const OTHER_POSES: &str = "/other/pose";

/// What a system's estimates look like in a viewer.
pub trait Drawing: Default {
    /// The system.
    type System;

    /// Whether it draws where the robot is. Poses that another program estimated are then kept apart, on [`OTHER_POSES`].
    const DRAWS_POSES: bool = true;

    /// Adds what the system made of `record`, which is written already.
    ///
    /// # Errors
    /// When it cannot be written.
    fn draw(
        &mut self,
        record: &Record,
        system: &Self::System,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError>;
}

/// Writes the estimates of a system beside the records of its log, into an MCAP file or to viewers, Foxglove and Rerun.
pub struct EstimateLog<D: Drawing> {
    writer: EstimateWriter,
    drawing: D,
    failure: Option<LogError>,
}

impl<D: Drawing> EstimateLog<D> {
    /// Creates the file; `origin` is the format that the records come from.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: &Path, origin: Format) -> Result<Self, LogError> {
        Self::new(vec![Box::new(McapFile::create(path)?)], origin)
    }

    /// Writes into all of `sinks`.
    ///
    /// # Errors
    /// When one of them fails.
    pub fn new(sinks: Sinks, origin: Format) -> Result<Self, LogError> {
        let mut writer = MessageWriter::into_sink(sinks);
        writer.origin(origin)?;
        Ok(Self { writer, drawing: D::default(), failure: None })
    }

    /// Writes a record of the log and what the system made of it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &D::System) {
        if self.failure.is_none() {
            self.failure = self.write(record, system).err();
        }
    }

    /// Completes what was written.
    ///
    /// # Errors
    /// When anything could not be written.
    pub fn finish(self) -> Result<(), LogError> {
        match self.failure {
            Some(failure) => Err(failure),
            None => self.writer.finish(),
        }
    }

    fn write(&mut self, record: &Record, system: &D::System) -> Result<(), LogError> {
        let written = match &record.data {
            Data::EstimatedPose(pose) if D::DRAWS_POSES && pose.is_finite() => {
                self.writer.pose_in_frame(OTHER_POSES, record.stamp, topics::WORLD_FRAME, pose)
            }
            _ => self.writer.record(record),
        };
        match written {
            Err(LogError::NotFinite { .. }) => {} // refused by the system and counted there
            written => written?,
        }
        self.drawing.draw(record, system, &mut self.writer)
    }
}
