use std::collections::BTreeMap;
use std::fmt;

use crate::EncodedImage;

/// Maximum number of problems listed; the others are only counted.
const MAX_EXAMPLES: usize = 20;

/// Report of reading a log.
///
/// `Display` prints it for people, one line per fact.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ReadReport {
    /// Number of rows or messages read.
    pub rows_read: u64,
    /// Count of each kind of problem.
    pub problems: BTreeMap<RowProblemKind, u64>,
    /// The first problems, in the order of the log.
    pub examples: Vec<RowProblem>,
    /// Messages that this crate does not read: `topic (schema)`, or the first word of a CARMEN line, with their number.
    pub ignored: BTreeMap<String, u64>,
    /// Whether the log ends as it should.
    pub end: LogCompleteness,
    /// Assumptions and other warnings for the user, without repetitions.
    pub warnings: Vec<LogWarning>,
}

/// A warning for the user: an assumption, or doubtful data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogWarning {
    /// Its kind, as it is counted among the events: `laser_mount_unknown`.
    pub name: &'static str,
    /// Description with numbers, and the option that changes an assumption.
    pub text: String,
}

/// End of a log.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LogCompleteness {
    /// As it should; text logs that are not compressed always do.
    #[default]
    Complete,
    /// It breaks off, as after a crash of the recorder. Everything up to the last whole message was read.
    Truncated {
        /// Bytes that are there.
        file_bytes: u64,
        /// Bytes that are missing, at least: the rest of the record that was being written and the end mark.
        missing_bytes: u64,
    },
    /// It cannot be followed beyond some point. Everything before was read.
    Damaged {
        /// Position at which reading stopped; in a compressed text, in the uncompressed text.
        byte: u64,
        /// The reason.
        reason: String,
    },
}

/// A row or message with a problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowProblem {
    /// The file's name, without its folder.
    pub file: String,
    /// Line of a text file, index of a scan in a JSON file, of a message in an MCAP file or of an image in its folder; all count from 1.
    pub row: u64,
    /// Kind of problem.
    pub kind: RowProblemKind,
    /// The details.
    pub reason: String,
}

/// Kinds of trouble with a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum RowProblemKind {
    /// Too few or too many columns; left out.
    ColumnCount,
    /// A column is not the number it should be; left out.
    NotANumber,
    /// A number is NaN or infinite; left out.
    NotFinite,
    /// A time stamp is negative, beyond the year 2540 or far from its neighbours; skipped.
    BadStamp,
    /// Not a row of this format: unknown first word, a line too long or not text; left out.
    Unrecognized,
    /// The numbers contradict each other or an earlier row; left out.
    Inconsistent,
    /// Earlier than the row before it. Text logs are sorted, so it is kept.
    OutOfOrder,
    /// Not later than the row before it, in a log with an unreliable clock. Kept, 0.1 s after the row before.
    NotLater,
    /// Earlier than records already returned from a streamed log, or after a clock set back; skipped.
    TooLate,
    /// A message that does not match its schema; skipped.
    Undecodable,
    /// A chunk of messages with an invalid checksum or compression; skipped.
    DamagedChunk,
    /// A file of a split recording that is empty or of another format; skipped.
    UnreadableFile,
    /// A file that is no image, is truncated or claims too many pixels; skipped.
    UnreadableImage,
}

impl RowProblemKind {
    /// Whether the row is used all the same.
    pub(crate) fn keeps_the_row(self) -> bool {
        matches!(self, Self::OutOfOrder | Self::NotLater)
    }
}

impl ReadReport {
    /// Problems of all kinds together.
    pub fn n_problems(&self) -> u64 {
        self.problems.values().sum()
    }
    /// Whether the whole log was read without a problem or warning, up to a regular end.
    pub fn is_clean(&self) -> bool {
        self.n_problems() == 0 && self.end == LogCompleteness::Complete && self.warnings.is_empty()
    }
    /// Adds a warning, unless the same one is there.
    pub fn warn(&mut self, name: &'static str, text: impl Into<String>) {
        let warning = LogWarning { name, text: text.into() };
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }
    /// Says once that images are turned.
    pub fn warn_of_orientation(&mut self, image: &EncodedImage) {
        if let Some(orientation) = image.orientation() {
            self.warn(
                "image_orientation_applied",
                format!("EXIF orientation {orientation} turns images upright; boxes and calibration count in the turned image"),
            );
        }
    }
    /// Counts a problem, and lists it if it is among the first.
    pub fn add(&mut self, problem: RowProblem) {
        *self.problems.entry(problem.kind).or_default() += 1;
        if self.examples.len() < MAX_EXAMPLES {
            self.examples.push(problem);
        }
    }
    /// Counts `n_rows` already read rows as skipped, with the problem of the first.
    pub(crate) fn leave_out(&mut self, first: RowProblem, n_rows: u64) {
        self.rows_read -= n_rows.min(self.rows_read);
        *self.problems.entry(first.kind).or_default() += n_rows.saturating_sub(1);
        self.add(first);
    }
    /// Adds problems and warnings of another part of the same recording.
    pub fn join(&mut self, other: &Self) {
        self.rows_read += other.rows_read;
        for (kind, n) in &other.problems {
            *self.problems.entry(*kind).or_default() += n;
        }
        let room = MAX_EXAMPLES.saturating_sub(self.examples.len());
        self.examples.extend(other.examples.iter().take(room).cloned());
        other.warnings.iter().for_each(|warning| self.warn(warning.name, warning.text.clone()));
    }
    pub(crate) fn ignore(&mut self, topic: &str) {
        match self.ignored.get_mut(topic) {
            Some(count) => *count += 1,
            None => drop(self.ignored.insert(topic.to_owned(), 1)),
        }
    }
}

impl fmt::Display for ReadReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} rows read, {} problems", self.rows_read, self.n_problems())?;
        for (kind, count) in &self.problems {
            writeln!(f, "  {kind}: {count}")?;
        }
        for problem in &self.examples {
            writeln!(f, "  {problem}")?;
        }
        let unnamed = self.n_problems() - self.examples.len() as u64;
        if unnamed > 0 {
            writeln!(f, "  … and {unnamed} more")?;
        }
        for (topic, count) in &self.ignored {
            writeln!(f, "ignored {topic}: {count} messages")?;
        }
        if self.end != LogCompleteness::Complete {
            writeln!(f, "{}", self.end)?;
        }
        self.warnings.iter().try_for_each(|warning| writeln!(f, "{warning}"))
    }
}

impl fmt::Display for LogWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "warning: {}", self.text)
    }
}

impl fmt::Display for RowProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.row, self.reason)
    }
}

impl fmt::Display for RowProblemKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ColumnCount => "wrong number of columns",
            Self::NotANumber => "not a number",
            Self::NotFinite => "not finite",
            Self::BadStamp => "bad time stamp",
            Self::Unrecognized => "not a row of this format",
            Self::Inconsistent => "inconsistent",
            Self::OutOfOrder => "out of time order",
            Self::NotLater => "time stands still",
            Self::TooLate => "too late",
            Self::Undecodable => "undecodable message",
            Self::DamagedChunk => "damaged chunk",
            Self::UnreadableFile => "unreadable file",
            Self::UnreadableImage => "unreadable image",
        })
    }
}

impl fmt::Display for LogCompleteness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => f.write_str("the log is complete"),
            Self::Truncated { file_bytes, missing_bytes } => {
                write!(f, "the log breaks off after {file_bytes} bytes, at least {missing_bytes} are missing")
            }
            Self::Damaged { byte, reason } => write!(f, "the log is damaged at byte {byte}: {reason}"),
        }
    }
}
