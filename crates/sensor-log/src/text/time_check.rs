use super::row::RowError;
use crate::{ProblemKind, Stamp};

/// Notices rows that are earlier than the row before.
///
/// Compares with the row before, not with the latest of all, so that one stamp from the far future does not
/// make every row after it look late.
#[derive(Default)]
pub(crate) struct TimeCheck {
    previous: Option<Stamp>,
}

impl TimeCheck {
    /// Call it after the row was taken: the row is reported, but kept.
    pub(crate) fn check(&mut self, stamp: Stamp) -> Result<(), RowError> {
        match self.previous.replace(stamp) {
            Some(previous) if stamp < previous => Err(RowError::new(
                ProblemKind::OutOfOrder,
                format!("{stamp} comes after {previous}; sorted into its place"),
            )),
            _ => Ok(()),
        }
    }
}
