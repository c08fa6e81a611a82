use anyhow::Result;
use serde::Deserialize;

use super::super::PlannedJob;
use crate::cml::{self as experiments, CmlExperimentSetup};
use wayfix_evaluation::report::ReportRun;

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    experiment: Experiment,
    /// Size of the full experiment.
    full: CmlExperimentSetup,
    /// The same with `--quick`, where that is something else.
    quick: Option<CmlExperimentSetup>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Experiment {
    /// Table 1.
    ChangingLab,
    /// Fig. 4.
    Laps,
    /// Fig. 5.
    FourWeeks,
    /// Fig. 6.
    ThreeDays,
    /// Global localization in a known map.
    GlobalStart,
    /// Kidnapped robots.
    Kidnapped,
    /// Kidnapped robots after the relocalization.
    AfterRelocalization,
    /// People before the camera.
    Crowded,
    /// Time of a step against the number of references.
    StepTime,
}

/// An experiment with the localizer.
pub(super) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let settings: Settings = job.planned.settings()?;
    let setup = settings.quick.filter(|_| job.options.quick).unwrap_or(settings.full);
    let experiment = match settings.experiment {
        Experiment::ChangingLab => experiments::changing_lab,
        Experiment::Laps => experiments::laps,
        Experiment::FourWeeks => experiments::four_weeks,
        Experiment::ThreeDays => experiments::three_days,
        Experiment::GlobalStart => experiments::global_start,
        Experiment::Kidnapped => experiments::kidnapped,
        Experiment::AfterRelocalization => experiments::after_relocalization,
        Experiment::Crowded => experiments::crowded,
        Experiment::StepTime => experiments::step_time,
    };
    experiment(&setup, job.options.seed)
}
