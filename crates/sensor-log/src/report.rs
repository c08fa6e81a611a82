use std::collections::BTreeMap;
use std::fmt;

/// How many problems a report names; the rest is only counted.
const MAX_EXAMPLES: usize = 20;

/// What was read of a log and what was not.
///
/// `Display` prints it for people, one line a fact.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ReadReport {
    /// Rows or messages that were understood.
    pub rows_read: u64,
    /// How often each kind of problem occurred.
    pub problems: BTreeMap<ProblemKind, u64>,
    /// The first problems, in the order of the log.
    pub examples: Vec<Problem>,
}

/// One row or message that gave trouble.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file's name, without its folder.
    pub file: String,
    /// Line of a text file, index of a message in an MCAP file; both count from 1.
    pub row: u64,
    /// What kind of trouble.
    pub kind: ProblemKind,
    /// What exactly.
    pub reason: String,
}

/// Kinds of trouble with a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ProblemKind {
    /// Too few or too many columns; left out.
    ColumnCount,
    /// A column is not the number it should be; left out.
    NotANumber,
    /// A number is NaN or infinite; left out.
    NotFinite,
    /// A time stamp is negative or beyond the year 2540; left out.
    BadStamp,
    /// Not a row of this format: unknown first word, a line too long or not text; left out.
    Unrecognized,
    /// The numbers contradict each other or an earlier row; left out.
    Inconsistent,
    /// Earlier than the row before it. Text logs are sorted, so it is kept.
    OutOfOrder,
}

impl ReadReport {
    /// Problems of all kinds together.
    pub fn n_problems(&self) -> u64 {
        self.problems.values().sum()
    }
    pub(crate) fn add(&mut self, problem: Problem) {
        *self.problems.entry(problem.kind).or_default() += 1;
        if self.examples.len() < MAX_EXAMPLES {
            self.examples.push(problem);
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
        Ok(())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.row, self.reason)
    }
}

impl fmt::Display for ProblemKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ColumnCount => "wrong number of columns",
            Self::NotANumber => "not a number",
            Self::NotFinite => "not finite",
            Self::BadStamp => "bad time stamp",
            Self::Unrecognized => "not a row of this format",
            Self::Inconsistent => "inconsistent",
            Self::OutOfOrder => "out of time order",
        })
    }
}
