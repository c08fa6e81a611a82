use std::path::PathBuf;

use anyhow::Result;
use serde::Deserialize;
use wayfix_evaluation::report::ReportRun;
use wayfix_sensor_log::{LogOpenOptions, read_relations};
use wayfix_slam_system::{
    points::{self, PointSlamParams, PointSystem, RobotProfile},
    ranges,
    slam::{AssociationRule, SlamEstimateRecorder, Smoothing},
    walls::{self, WallSlamParams},
};
use wayfix_system_core::RunStep;
use wayfix_table_log::RangeRecording;

use super::{super::PlannedJob, pose_graph};
use crate::thinned_measurements::ThinnedMeasurements;

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// Which robot, in sets of several.
    robot: Option<u32>,
    /// Data association.
    association: Option<AssociationRule>,
    /// The robot profile, if it differs from that of the log's format.
    profile: Option<RobotProfile>,
    /// A file of parameters, relative to the folder of the plan.
    params: Option<PathBuf>,
    /// Whether the landmarks are walls in laser scans.
    #[serde(default)]
    walls: bool,
    /// Whether a smoother estimates points, with a fixed lag.
    #[serde(default)]
    smoother: bool,
    /// Poses of the log as measurements of an external sensor.
    external: Option<ThinnedMeasurements>,
    /// File of known relations between poses, relative to the folder of recordings.
    relations: Option<PathBuf>,
}

/// A log through EKF-SLAM or the smoother, or a pose graph.
pub(super) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let settings: Settings = job.planned.settings()?;
    if settings.walls {
        return with_walls(job, &settings);
    }
    if pose_graph::is_named(job.log()?) {
        return pose_graph::run(job.log()?);
    }
    if RangeRecording::is_in(job.log()?) {
        let recording = RangeRecording::read(job.log()?)?;
        let run = ranges::run(&recording, &recording.truth)?;
        return Ok(ReportRun { figures: ranges::plots(&run)?, ..ranges::summarize(&run) });
    }
    let options = LogOpenOptions { robot: settings.robot, ..LogOpenOptions::default() };
    let log = wayfix_sensor_log::open(job.log()?, &options)?;
    let profile = settings.profile.unwrap_or(RobotProfile::of_log(log.meta()));
    let mut params = match &settings.params {
        Some(file) => PointSlamParams::from_toml(&job.read(file)?, profile)?,
        None => PointSlamParams::of(profile),
    };
    params.association = settings.association.or(params.association);
    if settings.smoother {
        params.smoothing = Smoothing::FixedLag;
    }

    let (name, path) = job.estimates_file();
    let mut estimates = SlamEstimateRecorder::create(&path, log.meta().first_format())?;
    let (mut records, read) = log.read_all();
    if let Some(external) = settings.external {
        params.external = external.params();
        records = external.in_log(records, job.options.seed);
    }
    let observe =
        |RunStep { system, record, .. }: RunStep<'_, PointSystem>| estimates.observe(record, system);
    let mut slam = points::run(&records, &params, observe)?;
    estimates.finish()?;
    slam.events().add("log_problem", read.n_problems());
    Ok(ReportRun { log: Some(name), figures: points::plots(&slam)?, ..points::summarize(&mut slam) })
}

/// A log of laser scans through EKF-SLAM with walls.
fn with_walls(job: &PlannedJob<'_>, settings: &Settings) -> Result<ReportRun> {
    let mut params = match &settings.params {
        Some(file) => wayfix_system_core::settings::from_toml(&job.read(file)?)?,
        None => WallSlamParams::default(),
    };
    let (mut records, read) = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?.read_all();
    if let Some(external) = settings.external {
        params.external = external.params();
        records = external.in_log(records, job.options.seed);
    }
    let mut slam = walls::run(&records, &params, |_| ())?;
    slam.events().add("log_problem", read.n_problems());
    let mut run = ReportRun { figures: walls::plots(&slam)?, ..walls::summarize(&mut slam) };
    if let Some(relations) = &settings.relations {
        let (relations, _) = read_relations(job.recording(relations)?)?;
        run.metrics.extend(walls::relation_metrics(&slam, &relations));
    }
    Ok(run)
}
