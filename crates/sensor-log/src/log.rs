use std::fmt;
use std::path::PathBuf;
use std::vec;

use crate::mcap_log::McapRecords;
use crate::{Format, ReadReport, Record};

/// An open log: an iterator over its records in time order, and what is known about it.
///
/// Iterate by reference when the report is wanted afterwards: for streamed formats it is complete only at the end.
pub struct Log {
    meta: LogMeta,
    records: Records,
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
    /// The file or folder.
    pub source: PathBuf,
    /// The robot whose records these are, in sets of several robots.
    pub robot: Option<u32>,
}

impl LogMeta {
    /// The format in which the records were first stored, as far as it is known; MCAP when nothing else is.
    pub fn first_format(&self) -> Format {
        self.origin.unwrap_or(self.format)
    }
}

enum Records {
    Memory(vec::IntoIter<Record>),
    Mcap { first: Option<Record>, rest: Box<McapRecords> },
}

impl Log {
    pub(crate) fn in_memory(meta: LogMeta, records: Vec<Record>, report: ReadReport) -> Self {
        Self { meta, records: Records::Memory(records.into_iter()), report }
    }
    pub(crate) fn streamed(meta: LogMeta, first: Record, rest: McapRecords, report: ReadReport) -> Self {
        Self { meta, records: Records::Mcap { first: Some(first), rest: Box::new(rest) }, report }
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
        match &mut self.records {
            Records::Memory(records) => records.next(),
            Records::Mcap { first, rest } => first.take().or_else(|| rest.next(&mut self.report)),
        }
    }
}

impl fmt::Debug for Log {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Log").field("meta", &self.meta).field("report", &self.report).finish_non_exhaustive()
    }
}
