use std::fs;
use std::path::{Path, PathBuf};

use crate::write::write_from;
use crate::{Log, LogError, LogFormat, ReadReport, WriteReport};

/// Writes the remaining records of a log to the file at `path`, replacing it, and reports what could not be read or written.
///
/// Records pass through one by one, so memory use does not grow with the log. An MCAP file stores the origin of its records
/// ([`LogMetadata::origin`](crate::LogMetadata::origin)), so that later readers treat them like the original ones.
/// ```
/// use wayfix_sensor_log::{LogFormat, LogOpenOptions, convert, open};
/// # let folder = tempfile::tempdir()?;
/// # let (text, mcap) = (folder.path().join("walk.txt"), folder.path().join("walk.mcap"));
/// std::fs::write(&text, "O 1 0 0\nZ 7 2 0.1\n")?;
/// let (read, written) = convert(open(&text, &LogOpenOptions::default())?, &mcap, LogFormat::Mcap)?;
/// assert_eq!((read.rows_read, written.records_written), (2, 2));
/// assert_eq!(open(&mcap, &LogOpenOptions::default())?.meta().origin, Some(LogFormat::RangeBearing));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns an error if `path` is the log itself; else as [`write`](crate::write()).
pub fn convert(
    mut log: Log,
    path: impl AsRef<Path>,
    format: LogFormat,
) -> Result<(ReadReport, WriteReport), LogError> {
    let path = path.as_ref();
    // A path that does not exist has no canonical form and cannot be the log.
    let canonical = |path: &Path| fs::canonicalize(path).ok();
    let meta = log.meta();
    let is_source = |target: PathBuf| {
        meta.files.iter().chain([&meta.source]).any(|source| canonical(source).as_ref() == Some(&target))
    };
    if canonical(path).is_some_and(is_source) {
        return Err(LogError::SameFile { path: path.into() });
    }
    let origin = log.meta().first_format();
    let written = write_from(path, format, origin, log.by_ref())?;
    Ok((log.report().clone(), written))
}
