use crate::text::row::RowError;
use crate::{RowProblemKind, Stamp};

/// Between two rows of which the second is not later, nanoseconds.
const STEP_NANOSECONDS: u64 = 100_000_000;

/// Stamps for a log ordered by lines.
///
/// Some loggers print seconds since 1970 with six digits, so that all rows have the same stamp, and some clocks go back briefly.
#[derive(Default)]
pub(super) struct LineClock {
    last: Option<Stamp>,
    /// Total time by which the clock was set back so far, nanoseconds.
    set_back: u64,
}

impl LineClock {
    /// Notes that the clock was set back before the next row; later stamps are moved on.
    pub(super) fn was_set_back(&mut self, nanoseconds: u64) {
        self.set_back = self.set_back.saturating_add(nanoseconds).saturating_add(STEP_NANOSECONDS);
    }

    /// The stamp of a row: its own if it is later than the previous one, else a replacement with a problem.
    pub(super) fn next(&mut self, own: Stamp) -> (Stamp, Result<(), RowError>) {
        let own = Stamp::from_nanoseconds(own.nanoseconds().saturating_add(self.set_back));
        let (stamp, verdict) = match self.last {
            Some(last) if own <= last => {
                let made_up = Stamp::from_nanoseconds(last.nanoseconds().saturating_add(STEP_NANOSECONDS));
                let reason = format!("{own} is not later than {last} before it; becomes {made_up}");
                (made_up, Err(RowError::new(RowProblemKind::NotLater, reason)))
            }
            _ => (own, Ok(())),
        };
        self.last = Some(stamp);
        (stamp, verdict)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_goes_on_whatever_the_stamps_say() {
        let mut clock = LineClock::default();
        let mut next = |milliseconds: u64| {
            let (stamp, verdict) = clock.next(Stamp::from_nanoseconds(milliseconds * 1_000_000));
            (stamp.nanoseconds() / 1_000_000, verdict.is_ok())
        };
        let given = [5, 5, 5, 204, 206, 1000, 900, 1050, 2000].map(&mut next);
        let expected = [
            (5, true),
            (105, false),
            (205, false),
            (305, false),
            (405, false),
            (1000, true),
            (1100, false),
            (1200, false),
            (2000, true),
        ];
        assert_eq!(given, expected);
    }
}
