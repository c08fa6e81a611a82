use std::io::{self, BufRead};
use std::path::{Path, PathBuf};

use super::row::RowError;
use crate::formats::compressed::{TextReader, end_of_damaged, open_text};
use crate::{LogCompleteness, LogError, ReadReport, RowProblem, RowProblemKind};

/// Maximum length of a row, in bytes. Rows of known formats are shorter: scanners of 1,440 beams print about 20 kB with remissions.
const MAX_LINE_BYTES: usize = 64 << 10;

/// The rows of a text file: neither blank nor a `#` comment.
pub(crate) struct Lines<R> {
    reader: R,
    path: PathBuf,
    number: u64,
    n_bytes: u64,
    buffer: Vec<u8>,
    /// Whether the last line ended in CR.
    after_cr: bool,
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
        Self { reader, path: path.into(), number: 0, n_bytes: 0, buffer: Vec::new(), after_cr: false }
    }

    /// Passes every row to `read_row`; rejected rows go into the report.
    pub(crate) fn for_each_row(
        self,
        report: &mut ReadReport,
        mut read_row: impl FnMut(&str) -> Result<(), RowError>,
    ) -> Result<(), LogError> {
        self.for_each_numbered_row(report, |_, row| read_row(row))
    }

    /// Passes every row with its number to `read_row`; rejected rows go into the report.
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
                _ => self.buffer.len() > MAX_LINE_BYTES,
            };
            if too_long {
                let reason = format!("line is longer than {MAX_LINE_BYTES} bytes");
                return Ok(Some(Row {
                    number: self.number,
                    text: Err(RowError { kind: RowProblemKind::Unrecognized, reason }),
                }));
            }
            let significant = self.buffer.trim_ascii();
            if !significant.is_empty() && significant[0] != b'#' {
                break;
            }
        }
        let text = std::str::from_utf8(self.buffer.trim_ascii())
            .map_err(|_| RowError { kind: RowProblemKind::Unrecognized, reason: "line is not text".into() });
        Ok(Some(Row { number: self.number, text }))
    }

    /// The file's name, without its folder.
    pub(crate) fn file_name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Number of text bytes read so far.
    pub(crate) fn n_bytes(&self) -> u64 {
        self.n_bytes
    }

    /// End of the log after a read error; a damaged file keeps the records read before.
    pub(crate) fn end_after(&self, error: LogError) -> Result<LogCompleteness, LogError> {
        match &error {
            LogError::Io { source, .. } => end_of_damaged(&self.path, source, self.n_bytes).ok_or(error),
            _ => Err(error),
        }
    }

    /// Fills the buffer with one line without its end, and skips the part beyond the limit. Returns the length with the end, 0 at the end of the
    /// file. Lines end in LF, CR LF or CR.
    fn read_line(&mut self) -> io::Result<usize> {
        self.buffer.clear();
        let mut n_bytes = 0;
        let mut has_end = false;
        while !has_end {
            let chunk = match self.reader.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                chunk => chunk?,
            };
            if chunk.is_empty() {
                break;
            }
            // The LF of a CR LF is no line end of its own.
            let n_left_over = usize::from(std::mem::take(&mut self.after_cr) && chunk[0] == b'\n');
            let text = &chunk[n_left_over..];
            let length = text.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            has_end = length.is_some();
            let line = &text[..length.unwrap_or(text.len())];
            self.after_cr = length.is_some_and(|end| text[end] == b'\r');
            let n_free = (MAX_LINE_BYTES + 1).saturating_sub(self.buffer.len());
            self.buffer.extend_from_slice(&line[..line.len().min(n_free)]);
            let n_line = line.len() + usize::from(has_end);
            n_bytes += n_line;
            self.n_bytes += (n_left_over + n_line) as u64;
            self.reader.consume(n_left_over + n_line);
        }
        Ok(n_bytes)
    }
}

impl ReadReport {
    /// Counts a row as read, or with its problem.
    pub(super) fn count_row(&mut self, file: &str, row: u64, read: Result<(), RowError>) {
        match read {
            Ok(()) => self.rows_read += 1,
            Err(RowError { kind, reason }) => {
                self.rows_read += u64::from(kind.keeps_the_row());
                self.add(RowProblem { file: file.to_owned(), row, kind, reason });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str, capacity: usize) -> Vec<(u64, String)> {
        let reader = io::BufReader::with_capacity(capacity, text.as_bytes());
        let mut lines = Lines::new(reader, Path::new("rows.txt"));
        let mut rows = Vec::new();
        while let Some(row) = lines.next_row().unwrap() {
            rows.push((row.number, row.text.unwrap().to_owned()));
        }
        assert_eq!(lines.n_bytes(), text.len() as u64);
        rows
    }

    #[test]
    fn lines_end_in_lf_or_cr_or_both() {
        for end in ["\n", "\r", "\r\n"] {
            let text = ["one", "", "# two", " three ", "four"].join(end);
            let expected = [(1, "one".to_owned()), (4, "three".to_owned()), (5, "four".to_owned())];
            for capacity in [1, 4, 5, 1000] {
                assert_eq!(rows(&text, capacity), expected, "{end:?} {capacity}");
                assert_eq!(rows(&(text.clone() + end), capacity), expected, "{end:?} {capacity}");
            }
        }
    }
}
