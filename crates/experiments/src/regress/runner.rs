use std::{fs, path::PathBuf};

use anyhow::{Context, Result};
use rayon::prelude::*;

use super::{Cell, Job, Plan, Shard, campaign::job, cells, suites};
use wayfix_evaluation::report::Run;
use wayfix_systems::system::Stopwatch;

/// Work to do and output folder.
#[derive(Clone, Debug)]
pub struct Options {
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

impl Options {
    /// The seeds of the campaign.
    pub(super) fn seeds(&self) -> impl Iterator<Item = u64> + use<> {
        (0..self.n_seeds.max(1)).zip(self.seed..).map(|(_, seed)| seed)
    }
}

/// A piece of work that is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// Path of the file.
    pub cell: Cell,
    /// The result, without bounds.
    pub run: Run,
}

/// Does the shard's part of the work, several pieces at a time, and calls `done` with the name of each run that is finished.
///
/// The figures depend neither on the number of threads nor on how the work is divided.
///
/// # Errors
/// Returns an error if a plan cannot be read or the output folder cannot be written. A log that fails is a run with an error.
pub fn run_shard(options: &Options, shard: Shard, done: &(impl Fn(&str) + Sync)) -> Result<Vec<Done>> {
    fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    let mine = cells(options)?.into_iter().enumerate().filter(|(index, _)| shard.takes(*index));
    let mine: Vec<Cell> = mine.map(|(_, cell)| cell).collect();
    let plans: Vec<(&str, Plan, suites::Runner)> = options
        .suites
        .iter()
        .map(|suite| Ok((suite.as_str(), Plan::read(&options.fixtures, suite)?, suites::named(suite)?)))
        .collect::<Result<_>>()?;
    let work = |cell: Cell| {
        let (_, plan, runner) = plans.iter().find(|(name, ..)| *name == cell.suite)?;
        let planned = plan.run.iter().find(|planned| planned.name == cell.run)?;
        let options = Options { seed: cell.seed, ..options.clone() };
        let run = run_one(&job(&options, planned)?, *runner);
        done(&run.name);
        Some(Done { cell, run })
    };
    Ok(mine.into_par_iter().filter_map(work).collect())
}

fn run_one(job: &Job<'_>, run: suites::Runner) -> Run {
    let stopwatch = Stopwatch::start();
    let run = match run(job) {
        Ok(run) => run,
        Err(error) => Run { error: Some(format!("{error:#}")), ..Run::default() },
    };
    Run { name: job.planned.name.clone(), seconds: stopwatch.elapsed().as_secs_f64(), ..run }
}
