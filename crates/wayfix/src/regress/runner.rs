use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use rayon::prelude::*;
use wayfix_sensor_log::OpenOptions;

use super::{Blessed, Plan, PlannedRun, plan::judge};
use crate::{
    report::{Machine, Report, Run, Suite, commit},
    slam::{self, EstimateLog, Profile, SlamSystemParams},
    system::Stopwatch,
};

/// What to run and where to put it.
#[derive(Clone, Debug)]
pub struct Options {
    /// Suites by name.
    pub suites: Vec<String>,
    /// Folder of the stored logs and plans.
    pub fixtures: PathBuf,
    /// Folder of public recordings, when there is one.
    pub data: Option<PathBuf>,
    /// Folder for the report.
    pub out: PathBuf,
    /// Seed of every generator.
    pub seed: u64,
    /// Stored logs only.
    pub quick: bool,
    /// Take the figures of the stored logs as right from now on.
    pub bless: bool,
}

/// Runs the suites, in parallel over their runs, and calls `done` with the name of each run that is finished.
///
/// The figures do not depend on the number of threads.
///
/// # Errors
/// When a plan cannot be read or the output folder cannot be written. A log that fails is a failed run of the report.
pub fn regress(options: &Options, done: &(impl Fn(&str) + Sync)) -> Result<Report> {
    fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    let suites = options.suites.iter().map(|suite| run_suite(options, suite, done)).collect::<Result<_>>()?;
    Ok(Report { suites, seed: options.seed, commit: commit(&options.fixtures), machine: Machine::detect() })
}

/// How many runs there will be.
///
/// # Errors
/// When a plan cannot be read.
pub fn n_runs(options: &Options) -> Result<usize> {
    let count = |suite: &String| {
        let plan = Plan::read(&options.fixtures, suite)?;
        Ok(plan.run.iter().filter(|planned| locate(options, planned).is_some()).count())
    };
    options.suites.iter().map(count).sum()
}

fn run_suite(options: &Options, suite: &str, done: &(impl Fn(&str) + Sync)) -> Result<Suite> {
    let plan = Plan::read(&options.fixtures, suite)?;
    let located = plan.run.iter().filter_map(|planned| Some((planned, locate(options, planned)?)));
    let mut runs: Vec<Run> = located
        .collect::<Vec<_>>()
        .par_iter()
        .map(|(planned, log)| {
            let run = run_one(options, planned, log);
            done(&run.name);
            run
        })
        .collect();

    let blessed_path = options.fixtures.join(format!("{suite}-figures.json"));
    let stored: Vec<&str> =
        plan.run.iter().filter(|run| run.log.is_some()).map(|run| run.name.as_str()).collect();
    if options.bless {
        Blessed::write(&blessed_path, runs.iter().filter(|run| stored.contains(&run.name.as_str())))?;
    }
    let blessed = Blessed::read(&blessed_path)?;
    for run in &mut runs {
        let changed = blessed.compare(run);
        run.metrics.extend(changed);
    }
    let means: Vec<Run> = plan.mean.iter().filter_map(|mean| mean.over(&runs)).collect();
    runs.extend(means);
    Ok(Suite { name: suite.to_owned(), runs })
}

/// Where the log of a run is; `None` for recordings that are not at hand or not asked for.
fn locate(options: &Options, planned: &PlannedRun) -> Option<PathBuf> {
    match (&planned.log, &planned.data) {
        (Some(log), _) => Some(options.fixtures.join(log)),
        (None, Some(data)) if !options.quick => {
            options.data.as_ref().map(|folder| folder.join(data)).filter(|path| path.exists())
        }
        _ => None,
    }
}

fn run_one(options: &Options, planned: &PlannedRun, log: &Path) -> Run {
    let stopwatch = Stopwatch::start();
    let mut run = match run_slam(options, planned, log) {
        Ok(run) => run,
        Err(error) => Run { error: Some(format!("{error:#}")), ..Run::default() },
    };
    judge(&planned.bound, &mut run.metrics);
    run.notes.extend(planned.note.clone());
    Run { name: planned.name.clone(), seconds: stopwatch.elapsed().as_secs_f64(), ..run }
}

fn run_slam(options: &Options, planned: &PlannedRun, path: &Path) -> Result<Run> {
    let log = wayfix_sensor_log::open(path, &OpenOptions { robot: planned.robot, ..OpenOptions::default() })?;
    let profile = planned.profile.unwrap_or(Profile::of_log(log.meta()));
    let mut params = match &planned.params {
        Some(file) => {
            let file = options.fixtures.join(file);
            let text =
                fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            SlamSystemParams::from_toml(&text, profile)?
        }
        None => SlamSystemParams::of(profile),
    };
    params.association = planned.association.or(params.association);

    let file_name = format!("{}.mcap", planned.name);
    let mut estimates = EstimateLog::create(&options.out.join(&file_name))?;
    estimates.origin(log.meta().first_format())?;
    let (records, read) = log.read_all();
    let mut index = 0;
    let mut slam = slam::run(&records, &params, |system| {
        estimates.observe(&records[index], system);
        index += 1;
    })?;
    estimates.finish()?;
    slam.events().add("log_problem", read.n_problems());
    Ok(Run { log: Some(file_name), figures: slam::pictures(&slam)?, ..slam::summarize(&mut slam) })
}
