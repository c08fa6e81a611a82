use std::path::Path;

use wayfix_sensor_log::{
    FoxgloveMessageWriter, LogError, LogFormat, McapMessageSink, MessageSinks, Record, RecordData, topics,
};

/// Writer of estimates, to files or viewers.
pub type EstimateWriter = FoxgloveMessageWriter<MessageSinks>;

/// Topic of pose estimates in the log that come from another program.
pub const OTHER_POSES: &str = "/other/pose";

/// Draws a system's estimates for a viewer.
pub trait EstimateDrawer: Default {
    /// The system.
    type System;

    /// Whether it draws the robot's pose. Pose estimates of other programs then go to [`OTHER_POSES`].
    const DRAWS_POSES: bool = true;

    /// Draws the system's state after `record`, which is already written.
    ///
    /// # Errors
    /// Returns an error if writing fails.
    fn draw(
        &mut self,
        record: &Record,
        system: &Self::System,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError>;
}

/// Writes the estimates of a system beside the records of its log, to an MCAP file or to the viewers Foxglove and Rerun.
pub struct EstimateRecorder<D: EstimateDrawer> {
    writer: EstimateWriter,
    drawing: D,
    has_echo: bool,
    failure: Option<LogError>,
}

impl<D: EstimateDrawer> EstimateRecorder<D> {
    /// Creates the file; `origin` is the format of the source log.
    ///
    /// # Errors
    /// Returns an error if the file cannot be created.
    pub fn create(path: &Path, origin: LogFormat) -> Result<Self, LogError> {
        Self::new(vec![Box::new(McapMessageSink::create(path)?)], origin)
    }

    /// Writes into all of `sinks`.
    ///
    /// # Errors
    /// Returns an error if a sink fails.
    pub fn new(sinks: MessageSinks, origin: LogFormat) -> Result<Self, LogError> {
        let mut writer = FoxgloveMessageWriter::into_sink(sinks);
        writer.origin(origin)?;
        Ok(Self { writer, drawing: D::default(), has_echo: true, failure: None })
    }

    /// Writes the estimates only, without the records of the log.
    pub fn without_echo(self) -> Self {
        Self { has_echo: false, ..self }
    }

    /// Writes a record of the log and the estimates after it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &D::System) {
        if self.failure.is_none() {
            self.failure = self.write(record, system).err();
        }
    }

    /// Finishes writing.
    ///
    /// # Errors
    /// Returns an error if any write failed.
    pub fn finish(self) -> Result<(), LogError> {
        match self.failure {
            Some(failure) => Err(failure),
            None => self.writer.finish(),
        }
    }

    fn write(&mut self, record: &Record, system: &D::System) -> Result<(), LogError> {
        if self.has_echo {
            self.echo(record)?;
        }
        self.drawing.draw(record, system, &mut self.writer)
    }

    /// Writes the record itself.
    fn echo(&mut self, record: &Record) -> Result<(), LogError> {
        let written = match &record.data {
            RecordData::EstimatedPose(pose) if D::DRAWS_POSES && pose.is_finite() => {
                self.writer.pose_in_frame(OTHER_POSES, record.stamp, topics::WORLD_FRAME, pose)
            }
            _ => self.writer.record(record),
        };
        match written {
            Err(LogError::NotFinite { .. }) => Ok(()), // rejected by the system and counted there
            written => written,
        }
    }
}
