use std::iter::Sum;
use std::ops::Add;

use super::{FullReport, Metric, ReportRun, ReportSuite};

/// Number of figures that pass and fail.
///
/// A figure counts if it has a bound or is not finite; a run that ended early counts as one failure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PassFailCount {
    /// Figures within their bounds.
    pub passed: usize,
    /// Figures outside their bounds or not finite, and runs that ended early.
    pub failed: usize,
}

impl PassFailCount {
    /// Whether at least one figure counts and none fails: a report without bounds does not pass.
    pub fn all_pass(self) -> bool {
        self.failed == 0 && self.passed > 0
    }
}

impl FullReport {
    /// The tally of all suites.
    pub fn tally(&self) -> PassFailCount {
        self.suites.iter().map(ReportSuite::tally).sum()
    }
}

impl ReportSuite {
    /// The tally of all runs.
    pub fn tally(&self) -> PassFailCount {
        self.runs.iter().map(ReportRun::tally).sum()
    }
}

impl ReportRun {
    /// The tally of metrics and timings.
    pub fn tally(&self) -> PassFailCount {
        let ended_early = PassFailCount { passed: 0, failed: usize::from(self.error.is_some()) };
        self.all_metrics().map(Metric::tally).sum::<PassFailCount>() + ended_early
    }
}

impl Metric {
    fn tally(&self) -> PassFailCount {
        match (self.passes(), self.is_bounded()) {
            (false, _) => PassFailCount { passed: 0, failed: 1 },
            (true, true) => PassFailCount { passed: 1, failed: 0 },
            (true, false) => PassFailCount::default(),
        }
    }
}

impl Add for PassFailCount {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { passed: self.passed + other.passed, failed: self.failed + other.failed }
    }
}

impl Sum for PassFailCount {
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
        let run =
            ReportRun { metrics, timings: vec![Metric::new("lost", f64::NAN, "")], ..ReportRun::default() };
        assert_eq!(run.tally(), PassFailCount { passed: 1, failed: 2 });
        let broken = ReportRun { error: Some("no record".to_owned()), ..ReportRun::default() };
        assert_eq!(broken.tally(), PassFailCount { passed: 0, failed: 1 });
        assert!(!FullReport::default().tally().all_pass(), "nothing judged is not a pass");
    }
}
