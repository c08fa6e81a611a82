use std::{fs, path::PathBuf};

use anyhow::{Context, Result};
use rayon::prelude::*;

use super::{CampaignShard, PlannedJob, SeededRun, SuitePlan, campaign::job, cells, suites};
use wayfix_evaluation::report::ReportRun;
use wayfix_systems::system::Stopwatch;

/// Work to do and output folder.
#[derive(Clone, Debug)]
pub struct RegressOptions {
    /// Suites by name.
    pub suites: Vec<String>,
    /// Folder of the stored logs and plans.
    pub fixtures: PathBuf,
    /// Folder of public recordings, if available.
    pub data: Option<PathBuf>,
    /// Folder for the report.
    pub out: PathBuf,
    /// Seed of every generator.
    pub seed: u64,
    /// Number of seeds per run, from that one on.
    pub n_seeds: u64,
    /// Stored logs and short experiments only.
    pub quick: bool,
    /// Take the figures of the stored logs as right from now on.
    pub bless: bool,
}

impl RegressOptions {
    /// The seeds of the campaign.
    pub(super) fn seeds(&self) -> impl Iterator<Item = u64> + use<> {
        (0..self.n_seeds.max(1)).zip(self.seed..).map(|(_, seed)| seed)
    }
}

/// A piece of work that is done.
#[derive(Clone, Debug, PartialEq)]
pub struct CompletedRun {
    /// Path of the file.
    pub cell: SeededRun,
    /// The result, without bounds.
    pub run: ReportRun,
}

/// Does the shard's part of the work, several pieces at a time, and calls `done` with the name of each run that is finished.
///
/// The figures depend neither on the number of threads nor on how the work is divided.
///
/// # Errors
/// Returns an error if a plan cannot be read or the output folder cannot be written. A log that fails is a run with an error.
pub fn run_shard(
    options: &RegressOptions,
    shard: CampaignShard,
    done: &(impl Fn(&str) + Sync),
) -> Result<Vec<CompletedRun>> {
    fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    let mine = cells(options)?.into_iter().enumerate().filter(|(index, _)| shard.takes(*index));
    let mine: Vec<SeededRun> = mine.map(|(_, cell)| cell).collect();
    let plans: Vec<(&str, SuitePlan, suites::Runner)> = options
        .suites
        .iter()
        .map(|suite| Ok((suite.as_str(), SuitePlan::read(&options.fixtures, suite)?, suites::named(suite)?)))
        .collect::<Result<_>>()?;
    let work = |cell: SeededRun| {
        let (_, plan, runner) = plans.iter().find(|(name, ..)| *name == cell.suite)?;
        let planned = plan.run.iter().find(|planned| planned.name == cell.run)?;
        let options = RegressOptions { seed: cell.seed, ..options.clone() };
        let run = run_one(&job(&options, planned)?, *runner);
        done(&run.name);
        Some(CompletedRun { cell, run })
    };
    Ok(mine.into_par_iter().filter_map(work).collect())
}

fn run_one(job: &PlannedJob<'_>, run: suites::Runner) -> ReportRun {
    let stopwatch = Stopwatch::start();
    let run = match run(job) {
        Ok(run) => run,
        Err(error) => ReportRun { error: Some(format!("{error:#}")), ..ReportRun::default() },
    };
    ReportRun { name: job.planned.name.clone(), seconds: stopwatch.elapsed().as_secs_f64(), ..run }
}
