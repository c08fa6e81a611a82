use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use wayfix_appearance_cml::{
    ArchivedDescriptorFormat, MapArchive, MapArchiveAppender, MapArchiveCompleteness, MapArchiveError,
};
use wayfix_sensor_log::{Record, Stamp};
use wayfix_system_core::write_atomically;

use super::{CmlSystem, PanoramaLocalizer};

/// Errors of writing and reading a map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SavedViewMapError {
    /// An operating-system error.
    #[error("{}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// The operating-system error.
        source: io::Error,
    },
    /// The file contains no usable map.
    #[error("{}", path.display())]
    Archive {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        source: MapArchiveError,
    },
    /// No view was processed, so there is nothing to save.
    #[error("no view was seen, so there is no map to save")]
    NoView,
}

/// Reads a map. An interrupted journal is used up to its last complete entry.
///
/// # Errors
/// Returns an error if the file cannot be read, is damaged, or has an unsupported version.
pub fn read_map(path: &Path) -> Result<MapArchive, SavedViewMapError> {
    let bytes = fs::read(path).map_err(|source| SavedViewMapError::Io { path: path.to_owned(), source })?;
    MapArchive::from_bytes(&bytes)
        .map_err(|source| SavedViewMapError::Archive { path: path.to_owned(), source })
}

/// A message if the end of the map is missing.
pub fn end_note(archive: &MapArchive) -> Option<String> {
    match archive.end() {
        MapArchiveCompleteness::Whole => None,
        MapArchiveCompleteness::Interrupted { whole_bytes } => Some(format!(
            "saving the map was interrupted: it is whole up to byte {whole_bytes}, the rest is left out"
        )),
    }
}

/// Saves the map periodically, in the time of the log, and at the end.
///
/// A save replaces the old file atomically. Later changes are appended as a journal, until the journal is longer than the map.
pub struct PeriodicMapSaver {
    path: PathBuf,
    /// Log time between two saves, s; `None` saves only at the end.
    period: Option<f64>,
    saved_at: Option<Stamp>,
    open: Option<OpenJournal>,
    failure: Option<SavedViewMapError>,
}

struct OpenJournal {
    journal: MapArchiveAppender,
    file: File,
    n_snapshot: usize,
    n_appended: usize,
}

impl PeriodicMapSaver {
    /// Creates a saver that writes to `path` every `period` seconds of log time.
    pub fn new(path: PathBuf, period: Option<f64>) -> Self {
        Self { path, period, saved_at: None, open: None, failure: None }
    }

    /// Saves if the period has passed. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &CmlSystem) {
        let Some(period) = self.period else { return };
        let first = *self.saved_at.get_or_insert(record.stamp);
        if system.reader().size().is_some() && record.stamp.seconds_since(first) >= period {
            self.saved_at = Some(record.stamp);
            self.failure = self.save(system).err().or(self.failure.take());
        }
    }

    /// Saves the final state as a whole.
    ///
    /// # Errors
    /// Returns an error if this or any previous save failed.
    pub fn finish(mut self, system: &CmlSystem) -> Result<(), SavedViewMapError> {
        self.snapshot(system)?;
        self.failure.map_or(Ok(()), Err)
    }

    fn save(&mut self, system: &CmlSystem) -> Result<(), SavedViewMapError> {
        match &self.open {
            Some(open) if open.n_appended <= open.n_snapshot => self.append(system.localizer()),
            _ => self.snapshot(system),
        }
    }

    fn snapshot(&mut self, system: &CmlSystem) -> Result<(), SavedViewMapError> {
        let reader = system.reader();
        let params = ArchivedDescriptorFormat {
            views: *reader.params(),
            size: reader.size().ok_or(SavedViewMapError::NoView)?,
        };
        let (map, state) = (system.localizer().map(), system.localizer().state());
        let bytes = MapArchive::to_bytes(&params, map, state);
        self.open = None;
        let opened = write_atomically(&self.path, &bytes)
            .and_then(|()| OpenOptions::new().append(true).open(&self.path));
        let file = opened.map_err(|source| self.io(source))?;
        let journal = MapArchiveAppender::after(map);
        self.open = Some(OpenJournal { journal, file, n_snapshot: bytes.len(), n_appended: 0 });
        Ok(())
    }

    fn append(&mut self, localizer: &PanoramaLocalizer) -> Result<(), SavedViewMapError> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let bytes = open.journal.changes(localizer.map(), localizer.state());
        open.n_appended += bytes.len();
        let written = open.file.write_all(&bytes).and_then(|()| open.file.sync_data());
        if let Err(source) = written {
            // Do not append to a partial entry.
            self.open = None;
            return Err(self.io(source));
        }
        Ok(())
    }

    fn io(&self, source: io::Error) -> SavedViewMapError {
        SavedViewMapError::Io { path: self.path.clone(), source }
    }
}
