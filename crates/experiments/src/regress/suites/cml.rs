use anyhow::{Context, Result};
use serde::Deserialize;
use wayfix_sensor_log::LogOpenOptions;

use super::super::PlannedJob;
use crate::cml::{self as experiments, CmlExperimentSetup};
use wayfix_evaluation::report::ReportRun;
use wayfix_systems::{
    cml::{
        self, CameraViewGeometry, CmlEstimateRecorder, CmlParams, CmlRunPlan, CmlStartPose, CmlSystem,
        CmlTask, PanoramaMap, ViewDescriptorReader,
    },
    system::{RunStep, System},
};

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    experiment: Experiment,
    /// Size of the full experiment; none for a stored log.
    full: Option<CmlExperimentSetup>,
    /// The same with `--quick`, where that is something else.
    quick: Option<CmlExperimentSetup>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Experiment {
    /// A stored log: an empty map, a known start.
    Log,
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
    let experiment = match settings.experiment {
        Experiment::Log => return stored_log(job),
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
    let setup = settings.quick.filter(|_| job.options.quick).or(settings.full);
    experiment(&setup.context("give `full`, the size of the experiment")?, job.options.seed)
}

/// Builds the map from nothing while it localizes.
fn stored_log(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let log = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?;
    let (name, path) = job.estimates_file();
    let mut estimates = CmlEstimateRecorder::create(&path, log.meta().first_format())?;
    let (records, read) = log.read_all();
    let mut params = CmlParams::default();
    let plan = CmlRunPlan::of_log(records, 0, &mut params, &CameraViewGeometry::default())?;
    let start = cml::first_true_pose(&plan.records).context("a log without truth")?;
    let reader = ViewDescriptorReader::new(params.panorama_descriptor, None);
    let mut run = cml::run(
        CmlSystem::new(&params, reader, PanoramaMap::default())?,
        &plan,
        CmlTask::ConcurrentMapBuilding,
        CmlStartPose::Exactly(start),
        &params,
        job.options.seed,
        |RunStep { system, record, .. }| estimates.observe(record, system),
    )?;
    estimates.finish()?;
    run.system.events().add("log_problem", read.n_problems());
    Ok(ReportRun { log: Some(name), figures: cml::plots(&run)?, ..cml::summarize(&mut run) })
}
