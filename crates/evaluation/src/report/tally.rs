use std::iter::Sum;
use std::ops::Add;

use super::{Metric, Report, Run, Suite};

/// Number of figures that pass and fail.
///
/// A figure counts if it has a bound or is not finite; a run that ended early counts as one failure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Figures within their bounds.
    pub passed: usize,
    /// Figures outside their bounds or not finite, and runs that ended early.
    pub failed: usize,
}

impl Tally {
    /// Whether at least one figure counts and none fails: a report without bounds does not pass.
    pub fn all_pass(self) -> bool {
        self.failed == 0 && self.passed > 0
    }
}

impl Report {
    /// The tally of all suites.
    pub fn tally(&self) -> Tally {
        self.suites.iter().map(Suite::tally).sum()
    }
}

impl Suite {
    /// The tally of all runs.
    pub fn tally(&self) -> Tally {
        self.runs.iter().map(Run::tally).sum()
    }
}

impl Run {
    /// The tally of metrics and timings.
    pub fn tally(&self) -> Tally {
        let ended_early = Tally { passed: 0, failed: usize::from(self.error.is_some()) };
        self.all_metrics().map(Metric::tally).sum::<Tally>() + ended_early
    }
}

impl Metric {
    fn tally(&self) -> Tally {
        match (self.passes(), self.is_bounded()) {
            (false, _) => Tally { passed: 0, failed: 1 },
            (true, true) => Tally { passed: 1, failed: 0 },
            (true, false) => Tally::default(),
        }
    }
}

impl Add for Tally {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { passed: self.passed + other.passed, failed: self.failed + other.failed }
    }
}

impl Sum for Tally {
    fn sum<I: Iterator<Item = Self>>(tallies: I) -> Self {
        tallies.fold(Self::default(), Add::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_could_fail_counts() {
        let metrics = vec![
            Metric::new("free", 1.0, ""),
            Metric::new("good", 1.0, "").at_most(2.0),
            Metric::new("bad", 3.0, "").at_most(2.0),
        ];
        let run = Run { metrics, timings: vec![Metric::new("lost", f64::NAN, "")], ..Run::default() };
        assert_eq!(run.tally(), Tally { passed: 1, failed: 2 });
        let broken = Run { error: Some("no record".to_owned()), ..Run::default() };
        assert_eq!(broken.tally(), Tally { passed: 0, failed: 1 });
        assert!(!Report::default().tally().all_pass(), "nothing judged is not a pass");
    }
}
