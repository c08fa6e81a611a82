use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use super::row::RowError;
use crate::{LogError, Problem, ProblemKind, ReadReport};

/// No row of a known format comes near; what is longer is garbage and must not fill the memory.
const MAX_LINE_BYTES: u64 = 4096;

/// The rows of a text file: neither blank nor a `#` comment.
pub(crate) struct Lines<'p, R> {
    reader: R,
    path: &'p Path,
    number: u64,
    buffer: Vec<u8>,
}

/// A row and its line number, counting from 1.
pub(crate) struct Row<'a> {
    pub(crate) number: u64,
    pub(crate) text: Result<&'a str, RowError>,
}

impl<'p> Lines<'p, BufReader<File>> {
    pub(crate) fn open(path: &'p Path) -> Result<Self, LogError> {
        Ok(Self::new(BufReader::new(File::open(path).map_err(|source| LogError::io(path, source))?), path))
    }
}

impl<'p, R: BufRead> Lines<'p, R> {
    pub(crate) fn new(reader: R, path: &'p Path) -> Self {
        Self { reader, path, number: 0, buffer: Vec::new() }
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
        let file = self.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        while let Some(row) = self.next_row()? {
            match row.text.and_then(|text| read_row(row.number, text)) {
                Ok(()) => report.rows_read += 1,
                Err(RowError { kind, reason }) => {
                    // A row that only comes late is used all the same.
                    report.rows_read += u64::from(kind == ProblemKind::OutOfOrder);
                    report.add(Problem { file: file.clone(), row: row.number, kind, reason });
                }
            }
        }
        Ok(())
    }

    /// The next row; `None` at the end of the file.
    pub(crate) fn next_row(&mut self) -> Result<Option<Row<'_>>, LogError> {
        loop {
            self.number += 1;
            let too_long = match self.read_line().map_err(|source| LogError::io(self.path, source))? {
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

    /// Fills the buffer with one line, passes over what exceeds the limit; gives the length, 0 at the end.
    fn read_line(&mut self) -> io::Result<u64> {
        self.buffer.clear();
        let n_bytes = (&mut self.reader).take(MAX_LINE_BYTES + 1).read_until(b'\n', &mut self.buffer)? as u64;
        if n_bytes > MAX_LINE_BYTES && self.buffer.last() != Some(&b'\n') {
            self.reader.skip_until(b'\n')?;
        }
        Ok(n_bytes)
    }
}
