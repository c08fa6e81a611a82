use std::str::FromStr;

use crate::formats::format::shortened;
use crate::{RowProblemKind, Stamp};

/// Reason why a row is unusable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RowError {
    pub(crate) kind: RowProblemKind,
    pub(crate) reason: String,
}

impl RowError {
    pub(crate) fn new(kind: RowProblemKind, reason: impl Into<String>) -> Self {
        Self { kind, reason: reason.into() }
    }
}

/// Exactly `N` columns, separated by blanks or tabs.
pub(crate) fn columns<const N: usize>(row: &str) -> Result<[&str; N], RowError> {
    exactly(row.split_ascii_whitespace())
}

/// Exactly `N` columns, separated by commas.
pub(crate) fn comma_columns<const N: usize>(row: &str) -> Result<[&str; N], RowError> {
    exactly(row.split(',').map(str::trim_ascii))
}

/// Exactly `N` columns that were separated before.
pub(crate) fn exactly<'a, const N: usize>(
    found: impl Iterator<Item = &'a str>,
) -> Result<[&'a str; N], RowError> {
    let mut columns = [""; N];
    let mut n_columns = 0;
    for column in found {
        if let Some(slot) = columns.get_mut(n_columns) {
            *slot = column;
        }
        n_columns += 1;
    }
    if n_columns == N {
        Ok(columns)
    } else {
        Err(RowError::new(RowProblemKind::ColumnCount, format!("{n_columns} columns instead of {N}")))
    }
}

/// A finite number.
pub(crate) fn number(column: &str) -> Result<f64, RowError> {
    let value: f64 = parse(column, "a number")?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(RowError::new(RowProblemKind::NotFinite, format!("{:?} is not finite", shortened(column))))
    }
}

/// A positive number.
pub(crate) fn standard_deviation(column: &str) -> Result<f64, RowError> {
    let sigma = number(column)?;
    if sigma > 0.0 {
        Ok(sigma)
    } else {
        let reason = format!("the standard deviation {sigma} is not positive");
        Err(RowError::new(RowProblemKind::Inconsistent, reason))
    }
}

/// A range as printed: NaN and infinity mean no echo.
pub(crate) fn range(column: &str) -> Result<f64, RowError> {
    parse(column, "a range")
}

/// An identity.
pub(crate) fn id(column: &str) -> Result<u32, RowError> {
    parse(column, "an identity")
}

/// A column of seconds as a stamp.
pub(crate) fn stamp(column: &str) -> Result<Stamp, RowError> {
    stamp_of(number(column)?)
}

/// Seconds as a stamp.
pub(crate) fn stamp_of(seconds: f64) -> Result<Stamp, RowError> {
    Stamp::from_seconds(seconds)
        .ok_or_else(|| RowError::new(RowProblemKind::BadStamp, format!("{seconds} s is no time stamp")))
}

fn parse<T: FromStr>(column: &str, what: &str) -> Result<T, RowError> {
    column.parse().map_err(|_| {
        RowError::new(RowProblemKind::NotANumber, format!("{:?} is not {what}", shortened(column)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_what_is_wrong_with_a_column() {
        let kind = |result: Result<f64, RowError>| result.unwrap_err().kind;
        assert_eq!(number("-1.5e3").unwrap(), -1500.0);
        assert_eq!(kind(number("1,5")), RowProblemKind::NotANumber);
        assert_eq!(kind(number("nan")), RowProblemKind::NotFinite);
        assert_eq!(standard_deviation("0.5").unwrap(), 0.5);
        assert_eq!(kind(standard_deviation("-1")), RowProblemKind::Inconsistent);
        assert_eq!(standard_deviation("0").unwrap_err().reason, "the standard deviation 0 is not positive");
        assert_eq!(kind(number("1e999")), RowProblemKind::NotFinite);
        assert_eq!(stamp("-1").unwrap_err().kind, RowProblemKind::BadStamp);
        assert_eq!(id("4294967296").unwrap_err().kind, RowProblemKind::NotANumber);
        assert_eq!(columns::<2>(" a\t b ").unwrap(), ["a", "b"]);
        assert_eq!(comma_columns::<2>("a, b").unwrap(), ["a", "b"]);
        assert_eq!(columns::<2>("a b c").unwrap_err().reason, "3 columns instead of 2");
    }
}
