use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, de::DeserializeOwned};

use wayfix_evaluation::report::{Metric, ReportRun};

/// Runs of a suite with their bounds: a TOML file beside the stored logs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SuitePlan {
    /// In the order of the report.
    pub run: Vec<PlannedRun>,
    /// Means over runs; skipped if a run is missing.
    #[serde(default)]
    pub mean: Vec<PlannedMean>,
}

/// The mean of the figures of several runs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlannedMean {
    /// Its name, unique in the suite.
    pub name: String,
    /// Names of the runs.
    pub of: Vec<String>,
    /// Which figures.
    pub metrics: Vec<String>,
    /// Bounds and figures of others.
    #[serde(default)]
    pub bound: Vec<MetricBound>,
}

/// One log, or one experiment that makes its own, through one system.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct PlannedRun {
    /// Its name, unique in the suite.
    pub name: String,
    /// A stored log, relative to the folder of the plan.
    pub log: Option<PathBuf>,
    /// A public recording, relative to the folder given by `--data`.
    pub data: Option<PathBuf>,
    /// Too long for `--quick`.
    #[serde(default)]
    pub slow: bool,
    /// A remark for the reader.
    pub note: Option<String>,
    /// Bounds and figures of others.
    #[serde(default)]
    pub bound: Vec<MetricBound>,
    /// All other keys: settings of the suite.
    #[serde(flatten)]
    settings: toml::Table,
}

/// Bounds of a figure, and values to compare it with.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MetricBound {
    /// Name of the figure.
    pub metric: String,
    /// Smallest value that passes.
    pub low: Option<f64>,
    /// Largest value that passes.
    pub high: Option<f64>,
    /// Value in the paper.
    pub paper: Option<f64>,
    /// Value of another program.
    pub peer: Option<f64>,
    /// Which program.
    pub peer_name: Option<String>,
    /// The argument, paper or peer that the bound comes from.
    pub source: String,
    /// Not enforced yet; the report states it beside the figure.
    #[serde(default)]
    pub open: bool,
}

impl SuitePlan {
    /// Reads the plan of a suite, `SUITE.toml` in the folder of the stored logs.
    ///
    /// # Errors
    /// Returns an error if it cannot be read, or a run names both a stored log and a recording.
    pub(crate) fn read(folder: &Path, suite: &str) -> Result<Self> {
        let path = folder.join(suite).with_extension("toml");
        let text =
            fs::read_to_string(&path).with_context(|| format!("cannot read the plan {}", path.display()))?;
        let plan: Self =
            toml::from_str(&text).with_context(|| format!("the plan {} is not usable", path.display()))?;
        for run in &plan.run {
            ensure!(run.log.is_none() || run.data.is_none(), "run {}: `log` or `data`, not both", run.name);
        }
        Ok(plan)
    }
}

impl PlannedRun {
    /// The suite's settings of the run.
    /// # Errors
    /// Returns an error if a key is unknown or its value is of another kind.
    pub(crate) fn settings<T: DeserializeOwned>(&self) -> Result<T> {
        let settings = self.settings.clone().try_into();
        settings.with_context(|| format!("the settings of run {} are not usable", self.name))
    }
}

impl PlannedMean {
    /// The mean over `runs`; `None` if one of them did not run.
    pub(crate) fn over(&self, runs: &[ReportRun]) -> Option<ReportRun> {
        let members: Option<Vec<&ReportRun>> =
            self.of.iter().map(|name| runs.iter().find(|run| &run.name == name)).collect();
        let members = members?;
        let mean = |name: &String| {
            let values = members.iter().map(|run| run.metrics.iter().find(|metric| &metric.name == name));
            let sum: f64 = values.clone().map(|metric| metric.map_or(f64::NAN, |metric| metric.value)).sum();
            let unit = values.flatten().next().map_or("", |metric| metric.unit.as_str());
            Metric::new(name, sum / members.len() as f64, unit)
        };
        let mut metrics: Vec<Metric> = self.metrics.iter().map(mean).collect();
        judge(&self.bound, &mut metrics);
        let notes = vec![format!("Mean over {}.", self.of.join(", "))];
        Some(ReportRun { name: self.name.clone(), metrics, notes, ..ReportRun::default() })
    }
}

/// Adds bounds and comparison values to our figures. A bounded figure that was not measured fails as NaN.
pub(super) fn judge(bounds: &[MetricBound], metrics: &mut Vec<Metric>) {
    for bound in bounds {
        let found = metrics.iter().position(|metric| metric.name == bound.metric);
        if found.is_none() && bound.low.is_none() && bound.high.is_none() {
            continue; // nothing to set the paper's value beside
        }
        let index = found.unwrap_or_else(|| {
            metrics.push(Metric::new(&bound.metric, f64::NAN, ""));
            metrics.len() - 1
        });
        let metric = &mut metrics[index];
        metric.paper = bound.paper.or(metric.paper);
        metric.open = bound.open;
        if bound.open {
            let wanted = [
                bound.low.map(|low| format!("at least {low}")),
                bound.high.map(|high| format!("at most {high}")),
            ];
            let wanted: Vec<String> = wanted.into_iter().flatten().collect();
            metric.bound_source = Some(format!("open, wanted {}: {}", wanted.join(" and "), bound.source));
        } else {
            (metric.low, metric.high) = (bound.low, bound.high);
            metric.bound_source = Some(bound.source.clone());
        }
        if let Some(value) = bound.peer {
            *metric = metric.clone().peer(bound.peer_name.clone().unwrap_or_default(), value);
        }
    }
}
