//! The suites: each runs its planned runs with its system.

mod cml;
mod color;
mod consistency;
mod lines;
mod pose_graph;
mod slam;
mod track;
mod views;

use anyhow::{Context, Result};
use wayfix_evaluation::report::ReportRun;

use super::PlannedJob;

/// Does one run.
pub(super) type Runner = fn(&PlannedJob<'_>) -> Result<ReportRun>;

const SUITES: [(&str, Runner); 7] = [
    ("cml", cml::run),
    ("color", color::run),
    ("consistency", consistency::run),
    ("lines", lines::run),
    ("slam", slam::run),
    ("track", track::run),
    ("views", views::run),
];

/// All suites, in the order of the report.
pub(crate) fn names() -> Vec<&'static str> {
    SUITES.iter().map(|(name, _)| *name).collect()
}

pub(super) fn named(name: &str) -> Result<Runner> {
    let found = SUITES.iter().find(|(known, _)| *known == name).map(|(_, runner)| *runner);
    found.with_context(|| format!("there is no suite {name}; there are {}", names().join(", ")))
}
