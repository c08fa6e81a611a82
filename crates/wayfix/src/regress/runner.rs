use std::{fs, path::PathBuf};

use anyhow::{Context, Result};
use rayon::prelude::*;

use super::{Blessed, Job, Plan, PlannedRun, plan::judge, suites};
use crate::{
    report::{Machine, Report, Run, Suite, commit},
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
    /// Stored logs and short experiments only.
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
        Ok(plan.run.iter().filter(|planned| job(options, planned).is_some()).count())
    };
    options.suites.iter().map(count).sum()
}

fn run_suite(options: &Options, suite: &str, done: &(impl Fn(&str) + Sync)) -> Result<Suite> {
    let plan = Plan::read(&options.fixtures, suite)?;
    let jobs: Vec<Job<'_>> = plan.run.iter().filter_map(|planned| job(options, planned)).collect();
    let run = suites::named(suite)?;
    let mut runs: Vec<Run> = jobs
        .par_iter()
        .map(|job| {
            let run = run_one(job, run);
            done(&run.name);
            run
        })
        .collect();

    let blessed_path = options.fixtures.join(format!("{suite}-figures.json"));
    let stored: Vec<&str> =
        plan.run.iter().filter(|run| run.data.is_none()).map(|run| run.name.as_str()).collect();
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

/// A run with what it needs; `None` for recordings that are not at hand and for what is not asked for.
fn job<'a>(options: &'a Options, planned: &'a PlannedRun) -> Option<Job<'a>> {
    let path = match (&planned.log, &planned.data) {
        _ if options.quick && (planned.slow || planned.data.is_some()) => return None,
        (Some(log), _) => Some(options.fixtures.join(log)),
        (None, Some(data)) => Some(options.data.as_ref()?.join(data)).filter(|path| path.exists()),
        (None, None) => None,
    };
    (planned.data.is_none() || path.is_some()).then_some(Job { options, planned, path })
}

fn run_one(job: &Job<'_>, run: suites::Runner) -> Run {
    let stopwatch = Stopwatch::start();
    let mut run = match run(job) {
        Ok(run) => run,
        Err(error) => Run { error: Some(format!("{error:#}")), ..Run::default() },
    };
    judge(&job.planned.bound, &mut run.metrics);
    run.notes.extend(job.planned.note.clone());
    Run { name: job.planned.name.clone(), seconds: stopwatch.elapsed().as_secs_f64(), ..run }
}
