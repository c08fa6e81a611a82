use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use crate::text::{range_bearing_writer, tum};
use crate::{LogError, LogFormat, McapWriter, Record};

/// Report of writing a log.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct WriteReport {
    /// Records that are in the file.
    pub records_written: u64,
    /// Count of the skipped records by kind, which the format cannot store.
    pub left_out: BTreeMap<&'static str, u64>,
}

impl WriteReport {
    pub(crate) fn leave_out(&mut self, what: &'static str) {
        *self.left_out.entry(what).or_default() += 1;
    }
}

/// Writes records to the file at `path`, replacing it.
///
/// MCAP stores everything. Range-bearing text loses stamps, velocities, car odometry, bare positions, scans, estimates, cameras and detections of
/// robots and unknown codes. TUM stores only poses: the estimated ones if there are any, else the true ones. The report counts the skipped records.
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{RecordData, LogFormat, LogOpenOptions, Record, Stamp, open, write};
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("log.mcap");
/// let record = Record { stamp: Stamp::from_nanoseconds(7), data: RecordData::TruePose(Pose2::new(1.0, 2.0, 0.3)) };
/// write(&path, LogFormat::Mcap, [record.clone()])?;
/// assert_eq!(open(&path, &LogOpenOptions::default())?.read_all().0, [record]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns an error if the format is read only (UTIAS, Victoria Park, CARMEN, JSON, images), a number is not finite, or the file cannot be written.
pub fn write(
    path: impl AsRef<Path>,
    format: LogFormat,
    records: impl IntoIterator<Item = Record>,
) -> Result<WriteReport, LogError> {
    write_from(path.as_ref(), format, format, records)
}

/// Writes records whose original format is `origin`.
pub(crate) fn write_from(
    path: &Path,
    format: LogFormat,
    origin: LogFormat,
    records: impl IntoIterator<Item = Record>,
) -> Result<WriteReport, LogError> {
    let mut report = WriteReport::default();
    match format {
        LogFormat::Utias
        | LogFormat::VictoriaPark
        | LogFormat::Carmen
        | LogFormat::ScanJson
        | LogFormat::Images => {
            return Err(LogError::NotWritable { format });
        }
        LogFormat::Mcap => {
            let mut writer = McapWriter::create(path)?;
            writer.origin(origin)?;
            for record in records {
                writer.record(&record)?;
                report.records_written += 1;
            }
            writer.finish()?;
        }
        LogFormat::RangeBearing | LogFormat::Tum => {
            let io = |source| LogError::io(path, source);
            let file = File::create(path);
            let file = file.map_err(|source| LogError::NotCreated { path: path.into(), source })?;
            let mut out = BufWriter::new(file);
            let mut not_finite = None;
            let finite = records.into_iter().map_while(|record| match record.data.check_finite() {
                Ok(()) => Some(record),
                Err(what) => {
                    not_finite = Some(LogError::NotFinite { what, stamp: record.stamp });
                    None
                }
            });
            match format {
                LogFormat::Tum => tum::write(&mut out, finite, &mut report),
                _ => range_bearing_writer::write(&mut out, finite, &mut report),
            }
            .and_then(|()| out.flush())
            .map_err(io)?;
            if let Some(error) = not_finite {
                return Err(error);
            }
        }
    }
    Ok(report)
}

impl fmt::Display for WriteReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} records written", self.records_written)?;
        for (what, count) in &self.left_out {
            writeln!(f, "  left out, no place in this format: {what}, {count} times")?;
        }
        Ok(())
    }
}
