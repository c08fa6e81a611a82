use std::fmt;
use std::path::PathBuf;
use std::vec;

use crate::image_folder::ImageFolder;
use crate::mcap_log::McapRecords;
use crate::text::carmen::CarmenLog;
use crate::{BagTopic, LogFormat, ReadReport, Record};

/// An open log: an iterator over its records in time order, with metadata.
///
/// Iterate by reference to keep access to the report: for streamed formats it is complete only at the end.
pub struct Log {
    meta: LogMetadata,
    /// The record that was read to see whether there is one.
    first: Option<Record>,
    rest: Records,
    report: ReadReport,
}

/// Metadata of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LogMetadata {
    /// The storage format.
    pub format: LogFormat,
    /// The original format of a [converted](crate::convert) log, if stored in it.
    pub origin: Option<LogFormat>,
    /// The file or folder; the first one of several named files.
    pub source: PathBuf,
    /// The files of an MCAP log; several if it was split.
    pub files: Vec<PathBuf>,
    /// Robot of the records, in data sets of several robots.
    pub robot: Option<u32>,
    /// Topics of ROS 2 messages, in file order, with their use.
    pub topics: Vec<BagTopic>,
}

impl LogMetadata {
    /// The original format of the records if known, else MCAP.
    pub fn first_format(&self) -> LogFormat {
        self.origin.unwrap_or(self.format)
    }
}

/// Source of the records.
pub(crate) enum Records {
    Memory(vec::IntoIter<Record>),
    Mcap(Box<McapRecords>),
    Carmen(Box<CarmenLog>),
    Images(ImageFolder),
}

impl Records {
    /// The next record in time order; problems go into the report.
    pub(crate) fn next(&mut self, report: &mut ReadReport) -> Option<Record> {
        match self {
            Self::Memory(records) => records.next(),
            Self::Mcap(records) => records.next(report),
            Self::Carmen(log) => log.next(report),
            Self::Images(folder) => folder.next(report),
        }
    }
}

impl Log {
    pub(crate) fn new(meta: LogMetadata, first: Record, rest: Records, report: ReadReport) -> Self {
        Self { meta, first: Some(first), rest, report }
    }
    /// Metadata of the log.
    pub fn meta(&self) -> &LogMetadata {
        &self.meta
    }
    /// Report of the reading so far.
    pub fn report(&self) -> &ReadReport {
        &self.report
    }
    /// All remaining records, and the complete report.
    pub fn read_all(mut self) -> (Vec<Record>, ReadReport) {
        let records = self.by_ref().collect();
        (records, self.report)
    }
}

impl Iterator for Log {
    type Item = Record;
    fn next(&mut self) -> Option<Record> {
        self.first.take().or_else(|| self.rest.next(&mut self.report))
    }
}

impl fmt::Debug for Log {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Log").field("meta", &self.meta).field("report", &self.report).finish_non_exhaustive()
    }
}
