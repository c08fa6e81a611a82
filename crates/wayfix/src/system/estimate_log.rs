use std::{fs::File, io::BufWriter, path::Path};

use wayfix_sensor_log::{Format, LogError, McapWriter, Record};

/// What a system's estimates look like in a viewer.
pub trait Drawing: Default {
    /// The system.
    type System;

    /// Adds what the system made of `record`, which is in the file already.
    ///
    /// # Errors
    /// When it cannot be written.
    fn draw(
        &mut self,
        record: &Record,
        system: &Self::System,
        writer: &mut McapWriter<BufWriter<File>>,
    ) -> Result<(), LogError>;
}

/// Writes the estimates of a system beside the records of its log into an MCAP file, for Foxglove and Rerun.
pub struct EstimateLog<D: Drawing> {
    writer: McapWriter<BufWriter<File>>,
    drawing: D,
    failure: Option<LogError>,
}

impl<D: Drawing> EstimateLog<D> {
    /// Creates the file; `origin` is the format that the records come from.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: &Path, origin: Format) -> Result<Self, LogError> {
        let mut writer = McapWriter::create(path)?;
        writer.origin(origin)?;
        Ok(Self { writer, drawing: D::default(), failure: None })
    }

    /// Writes a record of the log and what the system made of it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &D::System) {
        if self.failure.is_none() {
            self.failure = self.write(record, system).err();
        }
    }

    /// Completes the file.
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
        match self.writer.record(record) {
            Err(LogError::NotFinite { .. }) => {} // refused by the system and counted there
            written => written?,
        }
        self.drawing.draw(record, system, &mut self.writer)
    }
}
