use std::path::PathBuf;

use wayfix_sensor_log::{Record, Stamp};

use super::{Save, SavedMapError};

/// Saves a system while it runs, every so often by the clock of the log, and at its end.
pub struct Saver {
    path: PathBuf,
    /// Seconds of the log between two saves; only at the end, when not given.
    period: Option<f64>,
    saved_at: Option<Stamp>,
    failure: Option<SavedMapError>,
}

impl Saver {
    /// A saver to `path`, every `period` seconds of the log's time.
    pub fn new(path: PathBuf, period: Option<f64>) -> Self {
        Self { path, period, saved_at: None, failure: None }
    }

    /// Saves when it is time, after a record and before `next`. Only between two stamps, so that a resumed run knows by the
    /// stamp what was taken. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, next: Option<&Record>, system: &impl Save) {
        let Some(period) = self.period else { return };
        let is_whole = next.is_some_and(|next| next.stamp > record.stamp);
        let first = *self.saved_at.get_or_insert(record.stamp);
        if is_whole && record.stamp.seconds_since(first) >= period {
            self.saved_at = Some(record.stamp);
            self.failure = system.save().write(&self.path).err().or(self.failure.take());
        }
    }

    /// Saves the last state.
    ///
    /// # Errors
    /// When that or anything before could not be written.
    pub fn finish(self, system: &impl Save) -> Result<(), SavedMapError> {
        system.save().write(&self.path)?;
        self.failure.map_or(Ok(()), Err)
    }
}
