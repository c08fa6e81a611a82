use std::fmt;
use std::path::PathBuf;
use std::vec;

use crate::image_folder::ImageFolder;
use crate::mcap_log::McapRecords;
use crate::text::carmen::CarmenLog;
use crate::{Format, ReadReport, Record, Topic};

/// An open log: an iterator over its records in time order, and what is known about it.
///
/// Iterate by reference when the report is wanted afterwards: for streamed formats it is complete only at the end.
pub struct Log {
    meta: LogMeta,
    /// The record that was read to see whether there is one.
    first: Option<Record>,
    rest: Records,
    report: ReadReport,
}

/// Where a log comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LogMeta {
    /// How it is stored.
    pub format: Format,
    /// How it was stored before it was [converted](crate::convert), where it says so.
    pub origin: Option<Format>,
    /// The file or folder; of files that were named one by one, the first.
    pub source: PathBuf,
    /// The files of an MCAP log; several when it was split.
    pub files: Vec<PathBuf>,
    /// The robot whose records these are, in sets of several robots.
    pub robot: Option<u32>,
    /// The topics of ROS 2 messages, in the order of the file, and what becomes of each.
    pub topics: Vec<Topic>,
}

impl LogMeta {
    /// The format in which the records were first stored, as far as it is known; MCAP when nothing else is.
    pub fn first_format(&self) -> Format {
        self.origin.unwrap_or(self.format)
    }
}

/// Where the next record comes from.
pub(crate) enum Records {
    Memory(vec::IntoIter<Record>),
    Mcap(Box<McapRecords>),
    Carmen(Box<CarmenLog>),
    Images(ImageFolder),
}

impl Records {
    /// The next record in time order; trouble goes into the report.
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
    pub(crate) fn new(meta: LogMeta, first: Record, rest: Records, report: ReadReport) -> Self {
        Self { meta, first: Some(first), rest, report }
    }
    /// Where the log comes from.
    pub fn meta(&self) -> &LogMeta {
        &self.meta
    }
    /// What was read so far and what was not.
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
