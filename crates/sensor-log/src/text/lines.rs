use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

use super::row::RowError;
use crate::compressed::{TextReader, end_of_damaged, open_text};
use crate::{LogEnd, LogError, Problem, ProblemKind, ReadReport};

/// No row of a known format comes near; what is longer is garbage and must not fill the memory.
const MAX_LINE_BYTES: u64 = 16 << 10;

/// The rows of a text file: neither blank nor a `#` comment.
pub(crate) struct Lines<R> {
    reader: R,
    path: PathBuf,
    number: u64,
    n_bytes: u64,
    buffer: Vec<u8>,
}

/// A row and its line number, counting from 1.
pub(crate) struct Row<'a> {
    pub(crate) number: u64,
    pub(crate) text: Result<&'a str, RowError>,
}

impl Lines<TextReader> {
    pub(crate) fn open(path: &Path) -> Result<Self, LogError> {
        Ok(Self::new(open_text(path)?, path))
    }
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R, path: &Path) -> Self {
        Self { reader, path: path.into(), number: 0, n_bytes: 0, buffer: Vec::new() }
    }

    /// Hands every row to `read_row`; what it refuses goes into the report.
    pub(crate) fn for_each_row(
        self,
        report: &mut ReadReport,
        mut read_row: impl FnMut(&str) -> Result<(), RowError>,
    ) -> Result<(), LogError> {
        self.for_each_numbered_row(report, |_, row| read_row(row))
    }

    /// Hands every row with its number to `read_row`; what it refuses goes into the report.
    pub(crate) fn for_each_numbered_row(
        mut self,
        report: &mut ReadReport,
        mut read_row: impl FnMut(u64, &str) -> Result<(), RowError>,
    ) -> Result<(), LogError> {
        let file = self.file_name();
        loop {
            let row = match self.next_row() {
                Ok(Some(row)) => row,
                Ok(None) => return Ok(()),
                Err(error) => {
                    report.end = self.end_after(error)?;
                    return Ok(());
                }
            };
            let number = row.number;
            let read = row.text.and_then(|text| read_row(number, text));
            report.count_row(&file, number, read);
        }
    }

    /// The next row; `None` at the end of the file.
    pub(crate) fn next_row(&mut self) -> Result<Option<Row<'_>>, LogError> {
        loop {
            self.number += 1;
            let too_long = match self.read_line().map_err(|source| LogError::io(&self.path, source))? {
                0 => return Ok(None),
                n_bytes => n_bytes > MAX_LINE_BYTES,
            };
            if too_long {
                let reason = format!("line is longer than {MAX_LINE_BYTES} bytes");
                return Ok(Some(Row {
                    number: self.number,
                    text: Err(RowError { kind: ProblemKind::Unrecognized, reason }),
                }));
            }
            let significant = self.buffer.trim_ascii();
            if !significant.is_empty() && significant[0] != b'#' {
                break;
            }
        }
        let text = std::str::from_utf8(self.buffer.trim_ascii())
            .map_err(|_| RowError { kind: ProblemKind::Unrecognized, reason: "line is not text".into() });
        Ok(Some(Row { number: self.number, text }))
    }

    /// The file's name, without its folder.
    pub(crate) fn file_name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Bytes of text read so far.
    pub(crate) fn n_bytes(&self) -> u64 {
        self.n_bytes
    }

    /// How the log ends when reading it failed: what was read before stays, if the file itself is damaged.
    pub(crate) fn end_after(&self, error: LogError) -> Result<LogEnd, LogError> {
        match &error {
            LogError::Io { source, .. } => end_of_damaged(&self.path, source, self.n_bytes).ok_or(error),
            _ => Err(error),
        }
    }

    /// Fills the buffer with one line, passes over what exceeds the limit; gives the length, 0 at the end.
    fn read_line(&mut self) -> io::Result<u64> {
        self.buffer.clear();
        let n_bytes = (&mut self.reader).take(MAX_LINE_BYTES + 1).read_until(b'\n', &mut self.buffer)? as u64;
        self.n_bytes += n_bytes;
        if n_bytes > MAX_LINE_BYTES && self.buffer.last() != Some(&b'\n') {
            self.n_bytes += self.reader.skip_until(b'\n')? as u64;
        }
        Ok(n_bytes)
    }
}

impl ReadReport {
    /// A row that was read, or what is wrong with it.
    pub(super) fn count_row(&mut self, file: &str, row: u64, read: Result<(), RowError>) {
        match read {
            Ok(()) => self.rows_read += 1,
            Err(RowError { kind, reason }) => {
                self.rows_read += u64::from(kind.keeps_the_row());
                self.add(Problem { file: file.to_owned(), row, kind, reason });
            }
        }
    }
}
