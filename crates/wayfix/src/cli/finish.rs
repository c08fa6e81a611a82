//! What every `wayfix run` does at the end.

use std::{fs, path::Path};

use anyhow::{Context, Result};
use wayfix_sensor_log::{Format, LogEnd, ReadReport};

use super::output::{print, tell};
use crate::{
    report::{Machine, Report, Run, RunSummary, Suite, table, table::TableStyle},
    system::{Drawing, EstimateLog, Events},
};

/// The estimates beside the report.
pub(super) const ESTIMATES: &str = "estimates.mcap";

/// The file of the estimates in the output folder, which is made where need be; nothing without a folder.
pub(super) fn open_estimates<D: Drawing>(
    out: Option<&Path>,
    origin: Format,
) -> Result<Option<EstimateLog<D>>> {
    let Some(out) = out else { return Ok(None) };
    fs::create_dir_all(out).with_context(|| format!("cannot create {}", out.display()))?;
    Ok(Some(EstimateLog::create(&out.join(ESTIMATES), origin)?))
}

/// Names what was refused, and counts what could not be read.
pub(super) fn account(events: &mut Events, read: &ReadReport) {
    for refusal in events.refusals() {
        tell(format!("refused {refusal}"));
    }
    let n_unlisted = events.n_refusals() - events.refusals().len() as u64;
    if n_unlisted > 0 {
        tell(format!("refused … and {n_unlisted} more"));
    }
    events.add("log_problem", read.n_problems());
    if read.end != LogEnd::Complete {
        events.count("log_incomplete");
    }
}

/// Prints the figures, and writes the report where a folder is given.
pub(super) fn show(suite: &str, run: Run, out: Option<&Path>, json: bool, seed: u64) -> Result<()> {
    let figures = if json {
        serde_json::to_string(&RunSummary::new(&run, seed))? + "\n"
    } else {
        table::run(&run, TableStyle::of_stdout())
    };
    if let Some(out) = out {
        write_report(out, suite, run, seed)?;
    }
    print(figures)
}

fn write_report(out: &Path, suite: &str, run: Run, seed: u64) -> Result<()> {
    for (number, figure) in run.figures.iter().enumerate() {
        let path = out.join(format!("figure-{}.svg", number + 1));
        fs::write(&path, figure.standalone()).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let estimates = if run.log.is_some() { format!(", {ESTIMATES}") } else { String::new() };
    let suites = vec![Suite { name: suite.to_owned(), runs: vec![run] }];
    Report { suites, seed, commit: None, machine: Machine::detect() }.write(out)?;
    tell(format!("wrote index.html, report.json{estimates} and the figures as SVG to {}", out.display()));
    Ok(())
}
