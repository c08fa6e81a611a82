//! What ended how, in a line a run.

use super::number::{duration, significant};
use super::table::{TableStyle, mark, run};
use super::{FullReport, Metric, PassFailCount, ReportRun};

/// One finished run in a line: name, time, number of figures within their bounds, and the first that is not.
///
/// ```
/// use wayfix_evaluation::report::{Metric, ReportRun, run_line, table::TableStyle};
/// let metrics = vec![Metric::new("ate_rmse_m", 0.2, "m").at_most(0.1)];
/// let run = ReportRun { name: "loop".to_owned(), seconds: 2.0, metrics, ..ReportRun::default() };
/// let line = run_line("slam", &run, TableStyle::PLAIN);
/// assert!(line.starts_with("✗ slam / loop") && line.ends_with("1 of 1 not within bounds: ate_rmse_m 0.2000, at most 0.1000\n"), "{line}");
/// ```
pub fn run_line(suite: &str, run: &ReportRun, style: TableStyle) -> String {
    let PassFailCount { passed, failed } = run.tally();
    let mark = match (passed, failed) {
        (0, 0) => " ".to_owned(),
        (_, failed) => mark(failed == 0, style.colour),
    };
    let verdict = match (&run.error, run.first_failure()) {
        (Some(error), _) => format!("ended early: {error}"),
        (None, Some(metric)) => {
            format!("{failed} of {} not within bounds: {}", passed + failed, against_bounds(metric))
        }
        (None, None) if passed == 0 => "no bounds".to_owned(),
        (None, None) => format!("{passed} within bounds"),
    };
    format!("{mark} {:<42} {:>8}  {verdict}\n", format!("{suite} / {}", run.name), duration(run.seconds))
}

/// The tables of the runs that fail, and the tally with the first failure.
pub fn failures(report: &FullReport, style: TableStyle) -> String {
    let mut text = String::new();
    for (suite, failed) in report.runs().filter(|(_, run)| run.tally().failed > 0) {
        text +=
            &format!("\n{suite} / {} ({})\n{}", failed.name, duration(failed.seconds), run(failed, style));
    }
    text + "\n" + &tally(report)
}

/// Number of figures within their bounds, the first that is not, and what is open.
pub(super) fn tally(report: &FullReport) -> String {
    let PassFailCount { passed, failed } = report.tally();
    let mut text = format!("{passed} within bounds, {failed} not\n");
    if let Some(first) = report.first_failure() {
        text += &format!("first failure: {first}\n");
    }
    let n_open = report.open_metrics().count();
    if n_open > 0 {
        text += &format!("{n_open} open: wanted, not counted\n");
    }
    if !report.pending.is_empty() {
        text += &format!("{} runs not finished\n", report.pending.len());
    }
    text
}

/// A figure and the bounds that it misses.
fn against_bounds(metric: &Metric) -> String {
    let Metric { name, value, low, high, .. } = metric;
    if !value.is_finite() {
        return format!("{name} was not measured");
    }
    let bounds = [("at least", low), ("at most", high)];
    let bounds =
        bounds.into_iter().filter_map(|(words, bound)| Some(format!("{words} {}", significant((*bound)?))));
    format!("{name} {}, {}", significant(*value), bounds.collect::<Vec<_>>().join(" and "))
}

impl FullReport {
    /// All runs with the names of their suites.
    pub fn runs(&self) -> impl Iterator<Item = (&str, &ReportRun)> {
        self.suites.iter().flat_map(|suite| suite.runs.iter().map(|run| (suite.name.as_str(), run)))
    }

    /// The first run that fails, with its first figure or its error.
    pub(crate) fn first_failure(&self) -> Option<String> {
        let (suite, run) = self.runs().find(|(_, run)| run.tally().failed > 0)?;
        let what = match (&run.error, run.first_failure()) {
            (None, Some(metric)) => against_bounds(metric),
            (error, _) => format!("ended early: {}", error.as_deref().unwrap_or_default()),
        };
        Some(format!("{suite} / {}: {what}", run.name))
    }

    /// Figures that miss a bound which is wanted and does not count yet, with the names of suite and run.
    pub(crate) fn open_metrics(&self) -> impl Iterator<Item = (&str, &str, &Metric)> {
        self.runs().flat_map(|(suite, run)| {
            let open = run.all_metrics().filter(|metric| metric.open);
            open.map(move |metric| (suite, run.name.as_str(), metric))
        })
    }
}

impl ReportRun {
    /// The first figure that fails.
    pub(crate) fn first_failure(&self) -> Option<&Metric> {
        self.all_metrics().find(|metric| !metric.passes())
    }
}
