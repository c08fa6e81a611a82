use std::path::PathBuf;

use anyhow::Result;
use serde::Deserialize;
use wayfix_sensor_log::OpenOptions;

use super::super::Job;
use crate::{
    report::Run,
    slam::{self, AssociationRule, EstimateLog, Profile, SlamSystemParams},
};

/// What the plan says of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// Which robot, in sets of several.
    robot: Option<u32>,
    /// How sightings find their landmarks.
    association: Option<AssociationRule>,
    /// The robot's defaults, when they are not those of the log's format.
    profile: Option<Profile>,
    /// A file of parameters, relative to the folder of the plan.
    params: Option<PathBuf>,
}

/// A log through EKF-SLAM.
pub(super) fn run(job: &Job<'_>) -> Result<Run> {
    let settings: Settings = job.planned.settings()?;
    let options = OpenOptions { robot: settings.robot, ..OpenOptions::default() };
    let log = wayfix_sensor_log::open(job.log()?, &options)?;
    let profile = settings.profile.unwrap_or(Profile::of_log(log.meta()));
    let mut params = match &settings.params {
        Some(file) => SlamSystemParams::from_toml(&job.read(file)?, profile)?,
        None => SlamSystemParams::of(profile),
    };
    params.association = settings.association.or(params.association);

    let (name, path) = job.estimates();
    let mut estimates = EstimateLog::create(&path)?;
    estimates.origin(log.meta().first_format())?;
    let (records, read) = log.read_all();
    let mut index = 0;
    let mut slam = slam::run(&records, &params, |system| {
        estimates.observe(&records[index], system);
        index += 1;
    })?;
    estimates.finish()?;
    slam.events().add("log_problem", read.n_problems());
    Ok(Run { log: Some(name), figures: slam::pictures(&slam)?, ..slam::summarize(&mut slam) })
}
