use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{MachineInfo, Metric};
use crate::plot::SvgPlot;

/// All suites of one call, with the data needed to repeat it.
/// ```
/// use wayfix_evaluation::report::{Metric, FullReport, ReportRun, ReportSuite};
/// let run = ReportRun { name: "robot 1".to_owned(), metrics: vec![Metric::new("nees_mean", 2.9, "").at_most(4.0)], ..ReportRun::default() };
/// let report = FullReport { suites: vec![ReportSuite { name: "slam".to_owned(), runs: vec![run] }], seed: 1, ..FullReport::default() };
/// assert!(report.tally().all_pass());
/// assert!(serde_json::to_string(&report)?.contains(r#""pass":true"#));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FullReport {
    /// In the order in which they ran.
    pub suites: Vec<ReportSuite>,
    /// Seed of every generator.
    pub seed: u64,
    /// Revision of the source; `null` if unknown.
    pub commit: Option<String>,
    /// The machine.
    pub machine: MachineInfo,
    /// Runs that are not finished, as `suite / run`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pending: Vec<String>,
}

/// Runs that belong together: `slam`, `color`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReportSuite {
    /// Its name on the command line.
    pub name: String,
    /// In the order in which they ran.
    pub runs: Vec<ReportRun>,
}

/// One log through one estimator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReportRun {
    /// Its name, unique in its suite.
    pub name: String,
    /// Figures that the seed and the log decide, bit for bit.
    pub metrics: Vec<Metric>,
    /// Duration, s.
    pub seconds: f64,
    /// Figures that vary from call to call: times. Their bounds count like those of `metrics`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub timings: Vec<Metric>,
    /// Count of each kind of event: lost, rejected, new landmark.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub events: BTreeMap<String, u64>,
    /// Pictures in the order of the page; the drawings themselves are in the page only.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<SvgPlot>,
    /// Remarks for the reader, a paragraph each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Assumptions and warnings for the user, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// MCAP of the estimates, relative to the folder of the report.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub log: Option<String>,
    /// A layout with which Foxglove shows the log, beside the report.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<String>,
    /// Reason of an early end; such a run fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl ReportRun {
    /// Metrics, then timings.
    pub(crate) fn all_metrics(&self) -> impl Iterator<Item = &Metric> {
        self.metrics.iter().chain(&self.timings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn report() -> FullReport {
        let run = ReportRun {
            name: "utias-7-1".to_owned(),
            metrics: vec![
                Metric::new("ate_rmse_m", 0.25, "m").at_most(0.5).paper(0.3),
                Metric::new("nees_mean", f64::NAN, ""),
            ],
            seconds: 1.5,
            timings: vec![Metric::new("step_mean_us", 12.0, "µs")],
            events: BTreeMap::from([("rejected".to_owned(), 3)]),
            figures: vec![SvgPlot {
                title: "Map".to_owned(),
                svg: "<svg></svg>".to_owned(),
                ..SvgPlot::default()
            }],
            ..ReportRun::default()
        };
        FullReport {
            suites: vec![ReportSuite { name: "slam".to_owned(), runs: vec![run] }],
            seed: 7,
            ..FullReport::default()
        }
    }

    #[test]
    fn json_has_the_shape_of_the_contract() {
        let value = serde_json::to_value(report()).unwrap();
        let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(keys(&value), ["commit", "machine", "seed", "suites"]);
        assert_eq!((&value["seed"], &value["commit"]), (&json!(7), &Value::Null));
        let run = &value["suites"][0]["runs"][0];
        assert_eq!(
            (&value["suites"][0]["name"], &run["name"], &run["seconds"]),
            (&json!("slam"), &json!("utias-7-1"), &json!(1.5))
        );
        assert_eq!(
            run["metrics"],
            json!([
                {"name": "ate_rmse_m", "value": 0.25, "unit": "m", "low": null, "high": 0.5, "paper": 0.3, "pass": true},
                {"name": "nees_mean", "value": null, "unit": "", "low": null, "high": null, "paper": null, "pass": false},
            ])
        );
        assert!(!value.to_string().contains("<svg"), "drawings do not bloat the figures");
    }

    #[test]
    fn json_reads_back() {
        let text = serde_json::to_string(&report()).unwrap();
        let read: FullReport = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        let bare = r#"{"suites":[{"name":"s","runs":[{"name":"r","metrics":[],"seconds":0.1}]}],"seed":0,"commit":"abc","machine":{}}"#;
        assert_eq!(serde_json::from_str::<FullReport>(bare).unwrap().commit.as_deref(), Some("abc"));
    }
}
