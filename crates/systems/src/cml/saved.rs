use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use wayfix_appearance_cml::{ArchiveEnd, ArchiveError, ArchiveParams, Journal, MapArchive};
use wayfix_sensor_log::{Record, Stamp};

use super::{CmlSystem, PanoramaLocalizer};
use crate::saved::write_atomically;

/// Why a map could not be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SavedViewsError {
    /// The operating system refuses.
    #[error("{}", path.display())]
    Io {
        /// What was read or written.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The bytes are no map that can be used here.
    #[error("{}", path.display())]
    Archive {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: ArchiveError,
    },
    /// There is nothing to save: no view was ever seen.
    #[error("no view was seen, so there is no map to save")]
    NoView,
}

/// Reads a map. A journal that was interrupted is used as far as it is whole.
///
/// # Errors
/// When the file cannot be read, is damaged, or of another version.
pub fn read_map(path: &Path) -> Result<MapArchive, SavedViewsError> {
    let bytes = fs::read(path).map_err(|source| SavedViewsError::Io { path: path.to_owned(), source })?;
    MapArchive::from_bytes(&bytes)
        .map_err(|source| SavedViewsError::Archive { path: path.to_owned(), source })
}

/// Whether the end of a map is missing, in words.
pub fn end_note(archive: &MapArchive) -> Option<String> {
    match archive.end() {
        ArchiveEnd::Whole => None,
        ArchiveEnd::Interrupted { whole_bytes } => Some(format!(
            "saving the map was interrupted: it is whole up to byte {whole_bytes}, the rest is left out"
        )),
    }
}

/// Saves the map while it is learned, every so often by the clock of the log, and at the end.
///
/// The whole map is written in the stead of the old file, atomically; then what changes is appended to it as a journal, until the journal is longer
/// than the map.
pub struct MapSaver {
    path: PathBuf,
    /// Seconds of the log between two saves; only at the end, when not given.
    period: Option<f64>,
    saved_at: Option<Stamp>,
    open: Option<OpenJournal>,
    failure: Option<SavedViewsError>,
}

struct OpenJournal {
    journal: Journal,
    file: File,
    n_snapshot: usize,
    n_appended: usize,
}

impl MapSaver {
    /// A saver to `path`, every `period` seconds of the log's time.
    pub fn new(path: PathBuf, period: Option<f64>) -> Self {
        Self { path, period, saved_at: None, open: None, failure: None }
    }

    /// Saves when it is time. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &CmlSystem) {
        let Some(period) = self.period else { return };
        let first = *self.saved_at.get_or_insert(record.stamp);
        if system.reader().size().is_some() && record.stamp.seconds_since(first) >= period {
            self.saved_at = Some(record.stamp);
            self.failure = self.save(system).err().or(self.failure.take());
        }
    }

    /// Saves the last state, as a whole.
    ///
    /// # Errors
    /// When that or anything before could not be written.
    pub fn finish(mut self, system: &CmlSystem) -> Result<(), SavedViewsError> {
        self.snapshot(system)?;
        self.failure.map_or(Ok(()), Err)
    }

    fn save(&mut self, system: &CmlSystem) -> Result<(), SavedViewsError> {
        match &self.open {
            Some(open) if open.n_appended <= open.n_snapshot => self.append(system.localizer()),
            _ => self.snapshot(system),
        }
    }

    fn snapshot(&mut self, system: &CmlSystem) -> Result<(), SavedViewsError> {
        let reader = system.reader();
        let params =
            ArchiveParams { views: *reader.params(), size: reader.size().ok_or(SavedViewsError::NoView)? };
        let (map, state) = (system.localizer().map(), system.localizer().state());
        let bytes = MapArchive::to_bytes(&params, map, state);
        self.open = None;
        let opened = write_atomically(&self.path, &bytes)
            .and_then(|()| OpenOptions::new().append(true).open(&self.path));
        let file = opened.map_err(|source| self.io(source))?;
        let journal = Journal::after(map);
        self.open = Some(OpenJournal { journal, file, n_snapshot: bytes.len(), n_appended: 0 });
        Ok(())
    }

    fn append(&mut self, localizer: &PanoramaLocalizer) -> Result<(), SavedViewsError> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let bytes = open.journal.changes(localizer.map(), localizer.state());
        open.n_appended += bytes.len();
        let written = open.file.write_all(&bytes).and_then(|()| open.file.sync_data());
        if let Err(source) = written {
            // What is half written must not be followed by anything.
            self.open = None;
            return Err(self.io(source));
        }
        Ok(())
    }

    fn io(&self, source: io::Error) -> SavedViewsError {
        SavedViewsError::Io { path: self.path.clone(), source }
    }
}
