use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::ReportRun;

/// The object that `wayfix run --json` prints: figures by name, events by name, seed.
///
/// ```
/// use wayfix_evaluation::report::{Metric, ReportRun, RunSummary};
/// let run = ReportRun { metrics: vec![Metric::new("n_landmarks", 15.0, "")], ..ReportRun::default() };
/// let text = serde_json::to_string(&RunSummary::new(&run, 3))?;
/// assert_eq!(text, r#"{"metrics":{"n_landmarks":15.0},"events":{},"seed":3}"#);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunSummary {
    /// Metrics and timings; one that is not finite is absent.
    pub metrics: BTreeMap<String, f64>,
    /// Count of each kind of event.
    pub events: BTreeMap<String, u64>,
    /// Seed of every generator.
    pub seed: u64,
}

impl RunSummary {
    /// The summary of `run`.
    pub fn new(run: &ReportRun, seed: u64) -> Self {
        let finite = run.all_metrics().filter(|metric| metric.value.is_finite());
        Self {
            metrics: finite.map(|metric| (metric.name.clone(), metric.value)).collect(),
            events: run.events.clone(),
            seed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Metric;

    #[test]
    fn every_value_is_a_number() {
        let run = ReportRun {
            metrics: vec![Metric::new("ate_rmse_m", f64::NAN, "m"), Metric::new("nees_mean", 3.0, "")],
            timings: vec![Metric::new("step_mean_us", 8.5, "µs")],
            events: BTreeMap::from([("rejected".to_owned(), 2)]),
            ..ReportRun::default()
        };
        let summary = serde_json::to_value(RunSummary::new(&run, 1)).unwrap();
        let expected = serde_json::json!({"metrics": {"nees_mean": 3.0, "step_mean_us": 8.5}, "events": {"rejected": 2}, "seed": 1});
        assert_eq!(summary, expected);
    }
}
