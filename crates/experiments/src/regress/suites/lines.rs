use anyhow::{Result, ensure};
use serde::Deserialize;
use wayfix_evaluation::report::ReportRun;
use wayfix_line_extract::LineExtractionParams;
use wayfix_sensor_log::LogOpenOptions;
use wayfix_system_core::{RunStep, System, drive};
use wayfix_systems::lines::{self, LineEstimateRecorder, LineExtractionSystem};

use super::super::PlannedJob;
use crate::simplification::simplification;

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// Extraction parameters; omitted keys keep their defaults.
    #[serde(default)]
    params: LineExtractionParams,
    /// Number of random chains to simplify, instead of a log.
    n_polylines: Option<u32>,
}

/// The walls in the scans of a log, or chains made short.
pub(super) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let settings: Settings = job.planned.settings()?;
    match settings.n_polylines {
        Some(n_polylines) => simplification(n_polylines, job.options.seed),
        None => walls(job, settings.params),
    }
}

fn walls(job: &PlannedJob<'_>, params: LineExtractionParams) -> Result<ReportRun> {
    let log = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?;
    let (name, path) = job.estimates_file();
    let mut walls = LineEstimateRecorder::create(&path, log.meta().first_format())?;
    let (records, read) = log.read_all();
    let mut system = LineExtractionSystem::new(params)?;
    drive(&mut system, &records, |RunStep { system, record, .. }| walls.observe(record, system));
    walls.finish()?;
    ensure!(system.n_scans() > 0, "no laser scan in the log");
    system.events().add("log_problem", read.n_problems());
    Ok(ReportRun { log: Some(name), figures: lines::plots(&system)?, ..lines::summarize(&mut system) })
}
