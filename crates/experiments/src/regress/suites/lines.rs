use anyhow::{Result, ensure};
use serde::Deserialize;
use wayfix_line_extract::Params;
use wayfix_sensor_log::OpenOptions;

use super::super::Job;
use wayfix_evaluation::report::Run;
use wayfix_systems::{
    lines::{self, LineLog, LineSystem},
    system::{DriveStep, System, drive},
};

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// Extraction parameters; omitted keys keep their defaults.
    #[serde(default)]
    params: Params,
    /// Number of random chains to simplify, instead of a log.
    n_chains: Option<u32>,
}

/// The walls in the scans of a log, or chains made short.
pub(super) fn run(job: &Job<'_>) -> Result<Run> {
    let settings: Settings = job.planned.settings()?;
    match settings.n_chains {
        Some(n_chains) => lines::simplification(n_chains, job.options.seed),
        None => walls(job, settings.params),
    }
}

fn walls(job: &Job<'_>, params: Params) -> Result<Run> {
    let log = wayfix_sensor_log::open(job.log()?, &OpenOptions::default())?;
    let (name, path) = job.estimates();
    let mut walls = LineLog::create(&path, log.meta().first_format())?;
    let (records, read) = log.read_all();
    let mut system = LineSystem::new(params)?;
    drive(&mut system, &records, |DriveStep { system, record, .. }| walls.observe(record, system));
    walls.finish()?;
    ensure!(system.n_scans() > 0, "no laser scan in the log");
    system.events().add("log_problem", read.n_problems());
    Ok(Run { log: Some(name), figures: lines::pictures(&system)?, ..lines::summarize(&mut system) })
}
