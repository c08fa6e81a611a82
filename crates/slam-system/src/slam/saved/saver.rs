use std::path::PathBuf;

use serde::{Serialize, de::DeserializeOwned};
use wayfix_sensor_log::{Record, Stamp};

use super::{SavedMapError, SlamState};
use crate::slam::FrontEndState;

/// Saves a system while it runs, every so often by the clock of the log, and at its end.
pub struct PeriodicStateSaver {
    path: PathBuf,
    /// Seconds of the log between two saves; only at the end, when not given.
    period: Option<f64>,
    saved_at: Option<Stamp>,
    failure: Option<SavedMapError>,
}

impl PeriodicStateSaver {
    /// A saver to `path`, every `period` seconds of the log's time.
    pub fn new(path: PathBuf, period: Option<f64>) -> Self {
        Self { path, period, saved_at: None, failure: None }
    }

    /// Saves when it is time, after a record and before `next`. Only between two stamps, so that a resumed run knows by the
    /// stamp what was taken. A failure is kept until [`finish`](Self::finish).
    pub fn observe<R, L, S: FrontEndState>(
        &mut self,
        record: &Record,
        next: Option<&Record>,
        state: impl FnOnce() -> SlamState<R, L, S>,
    ) where
        SlamState<R, L, S>: Serialize + DeserializeOwned,
    {
        let Some(period) = self.period else { return };
        let is_whole = next.is_some_and(|next| next.stamp > record.stamp);
        let first = *self.saved_at.get_or_insert(record.stamp);
        if is_whole && record.stamp.seconds_since(first) >= period {
            self.saved_at = Some(record.stamp);
            self.failure = state().write(&self.path).err().or(self.failure.take());
        }
    }

    /// Saves the last state.
    ///
    /// # Errors
    /// When that or anything before could not be written.
    pub fn finish<R, L, S: FrontEndState>(self, state: &SlamState<R, L, S>) -> Result<(), SavedMapError>
    where
        SlamState<R, L, S>: Serialize + DeserializeOwned,
    {
        state.write(&self.path)?;
        self.failure.map_or(Ok(()), Err)
    }
}
