use std::{
    fs,
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
};

use anyhow::{Context, Result};
use rayon::prelude::*;
use wayfix_evaluation::report::ReportRun;
use wayfix_system_core::Stopwatch;

use super::{CampaignShard, PlannedJob, RunSelection, SeededRun, SuitePlan, campaign::job, cells, suites};

/// Work to do and output folder.
#[derive(Clone, Debug)]
pub(crate) struct RegressOptions {
    /// Suites and runs by name.
    pub selection: RunSelection,
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
pub(crate) struct CompletedRun {
    /// Which piece.
    pub cell: SeededRun,
    /// The result, without bounds.
    pub run: ReportRun,
}

/// Does the shard's part of the work, several pieces at a time, and shows each run to `done` as soon as it ends.
///
/// The figures depend neither on the number of threads nor on how the work is divided. Pieces in `finished` are not done again.
///
/// # Errors
/// Returns an error if a plan cannot be read or the output folder cannot be written. A log that fails is a run with an error, and so is one that
/// panics: the others continue.
pub(crate) fn run_shard(
    options: &RegressOptions,
    shard: CampaignShard,
    finished: &[SeededRun],
    done: &(impl Fn(CompletedRun) + Sync),
) -> Result<()> {
    fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    let plans: Vec<(&str, SuitePlan, suites::Runner)> = options
        .selection
        .suites
        .iter()
        .map(|suite| Ok((suite.as_str(), SuitePlan::read(&options.fixtures, suite)?, suites::named(suite)?)))
        .collect::<Result<_>>()?;
    let work = |cell: SeededRun| {
        let (_, plan, runner) = plans.iter().find(|(name, ..)| *name == cell.suite)?;
        let planned = plan.run.iter().find(|planned| planned.name == cell.run)?;
        let options = RegressOptions { seed: cell.seed, ..options.clone() };
        let run = run_one(&job(&options, planned)?, *runner);
        done(CompletedRun { cell, run });
        Some(())
    };
    let mut mine = shard.share(cells(options)?);
    mine.retain(|cell| !finished.contains(cell));
    mine.into_par_iter().for_each(|cell| {
        work(cell);
    });
    Ok(())
}

fn run_one(job: &PlannedJob<'_>, run: suites::Runner) -> ReportRun {
    let stopwatch = Stopwatch::start();
    let run = match catch_unwind(AssertUnwindSafe(|| run(job))) {
        Ok(Ok(run)) => run,
        Ok(Err(error)) => ReportRun { error: Some(format!("{error:#}")), ..ReportRun::default() },
        Err(_) => ReportRun { error: Some("a panic, see standard error".to_owned()), ..ReportRun::default() },
    };
    ReportRun { name: job.planned.name.clone(), seconds: stopwatch.elapsed().as_secs_f64(), ..run }
}
