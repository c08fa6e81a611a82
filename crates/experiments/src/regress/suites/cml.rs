use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::Deserialize;
use wayfix_evaluation::report::ReportRun;
use wayfix_sensor_log::LogOpenOptions;
use wayfix_system_core::{RunStep, System};
use wayfix_systems::cml::{
    self, CameraViewGeometry, CmlEstimateRecorder, CmlParams, CmlRun, CmlRunPlan, CmlRunSetup, CmlStartPose,
    CmlSystem, CmlTask, PanoramaMap, ViewDescriptorReader,
};
use wayfix_table_log::{PoseTables, PosedFrameFolder};

use super::super::PlannedJob;
use crate::{
    cml::{self as experiments, CmlExperimentSetup},
    thinned_measurements::ThinnedMeasurements,
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
    /// Table of the poses of a folder of frames, in that folder.
    poses: Option<PathBuf>,
    /// Names of its columns.
    columns: Option<String>,
    /// Poses of the log as measurements of an external sensor.
    external: Option<ThinnedMeasurements>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Experiment {
    /// A stored log: an empty map, a known start.
    Log,
    /// The same for a folder of frames with poses, whose odometry is made of them.
    Frames,
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
        Experiment::Log => return stored_log(job, &settings),
        Experiment::Frames => return frames(job, &settings),
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

/// Builds the map from nothing while it localizes in a stored log.
fn stored_log(job: &PlannedJob<'_>, settings: &Settings) -> Result<ReportRun> {
    let log = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?;
    let (name, path) = job.estimates_file();
    let mut estimates = CmlEstimateRecorder::create(&path, log.meta().first_format())?;
    let (records, read) = log.read_all();
    let mut params = CmlParams::default();
    let plan = CmlRunPlan::of_log(records, 0, &mut params, &CameraViewGeometry::default())?;
    let mut run = from_nothing(job, settings, plan, params, |RunStep { system, record, .. }| {
        estimates.observe(record, system);
    })?;
    estimates.finish()?;
    run.system.events().add("log_problem", read.n_problems());
    Ok(ReportRun { log: Some(name), figures: cml::plots(&run)?, ..cml::summarize(&mut run) })
}

/// The same in a folder of frames.
fn frames(job: &PlannedJob<'_>, settings: &Settings) -> Result<ReportRun> {
    let folder = job.log()?;
    let poses = folder.join(settings.poses.as_ref().context("frames need `poses`")?);
    let columns = settings.columns.as_deref().map(str::parse).transpose().map_err(anyhow::Error::msg)?;
    let tables = PoseTables { poses: &poses, columns: columns.as_ref(), stamps: None, stamp_columns: None };
    let recording = PosedFrameFolder::read(folder, &tables)?;
    let (mut params, camera) = (CmlParams::default(), CameraViewGeometry::default());
    let plan = CmlRunPlan::of_recording(&recording, None, 0, &mut params, &camera, job.options.seed)?;
    let mut run = from_nothing(job, settings, plan, params, |_| ())?;
    Ok(ReportRun { figures: cml::plots(&run)?, ..cml::summarize(&mut run) })
}

fn from_nothing(
    job: &PlannedJob<'_>,
    settings: &Settings,
    mut plan: CmlRunPlan,
    mut params: CmlParams,
    observe: impl FnMut(RunStep<'_, CmlSystem>),
) -> Result<CmlRun> {
    if let Some(external) = settings.external {
        params.external = external.params();
        plan.records = external.in_log(plan.records, job.options.seed);
    }
    let start = cml::first_true_pose(&plan.records).context("a log without truth")?;
    let reader = ViewDescriptorReader::new(params.panorama_descriptor, None);
    let system = CmlSystem::new(&params, reader, PanoramaMap::default())?;
    let task = CmlTask::ConcurrentMapBuilding;
    let (start, seed) = (CmlStartPose::Exactly(start), job.options.seed);
    cml::run(CmlRunSetup { system, plan: &plan, task, start, params: &params, seed }, observe)
}
