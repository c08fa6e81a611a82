use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result, ensure};
use wayfix_evaluation::{
    report::{FullReport, failures, table, table::TableStyle},
    terminal::print,
};

use super::session::RegressSession;
use crate::regress::{
    CampaignShard, RegressOptions, RunCosts, RunSelection, ShardResults, calibration_seconds, cells,
    run_shard,
};

/// Run every system on the stored logs, and compare the figures with their bounds.
///
/// Each figure has bounds, and each bound a source: a paper, another program, or an argument (fixtures/SUITE.toml). The exit code is 0 if every
/// figure is within its bounds, else 1. OUT/index.html shows trajectories, maps and figures; it is written after every run, so that
/// Ctrl-C keeps the finished runs and --resume continues.
///
/// Without names the stored logs of all suites run. A suite, a run or --all runs the experiments too, and public recordings if available.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Suites (cml, color, consistency, lines, slam, track, views) and runs (fig6, cml/laps) with all their experiments.
    #[arg(value_name = "SUITE|RUN")]
    names: Vec<String>,
    /// Every experiment of every suite.
    #[arg(long, conflicts_with_all = ["names", "quick"])]
    all: bool,
    /// Stored logs and short experiments only; the default without names.
    #[arg(long)]
    quick: bool,
    /// Continue an interrupted call: the finished runs in OUT are not run again.
    #[arg(long, conflicts_with = "bless")]
    resume: bool,
    /// Folder of public recordings: utias_mrclam/MRCLAM_Dataset7, range_bearing/slam_100.txt and others (docs/accuracy.md). Without it
    /// only stored logs run.
    #[arg(long, value_name = "DIR", env = "WAYFIX_DATA")]
    data: Option<PathBuf>,
    /// Folder for report.json, index.html and an MCAP of the estimates of each run.
    #[arg(long, value_name = "DIR", default_value = "target/regress")]
    out: PathBuf,
    /// Folder of the stored logs and of the plans with the bounds.
    #[arg(long, value_name = "DIR", default_value = "fixtures")]
    fixtures: PathBuf,
    /// Seed of every generator.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Repeat every run with this number of seeds, from --seed on, and report means with 95 % intervals.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..), conflicts_with = "bless")]
    seeds: u64,
    /// Run the K-th of N shares of the work and write OUT/part.json; `wayfix-experiments merge-reports` makes one report of all shares.
    #[arg(long, value_name = "K/N", default_value_t = CampaignShard::WHOLE, hide_default_value = true, conflicts_with = "bless")]
    shard: CampaignShard,
    /// Store the present figures of the stored logs as the reference; review the change first.
    #[arg(long)]
    bless: bool,
    /// Store the computing time of the runs (fixtures/costs.json), for the estimate at the start. Use it with --threads 1.
    #[arg(long, hide_short_help = true)]
    store_costs: bool,
    /// Threads [default: one a core]. The figures do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let is_default = arguments.names.is_empty() && !arguments.all;
    let options = RegressOptions {
        selection: RunSelection::named(&arguments.names, &arguments.fixtures)?,
        fixtures: arguments.fixtures,
        data: arguments.data,
        out: arguments.out,
        seed: arguments.seed,
        n_seeds: arguments.seeds,
        quick: arguments.quick || is_default,
        bless: arguments.bless,
    };
    let shard = arguments.shard;
    let finished = match arguments.resume {
        true => ShardResults::finished(&options.out, &options, shard)?,
        false => Vec::new(),
    };
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.unwrap_or(0)).build();
    let threads = threads.context("cannot start the threads")?;

    let calibration_s = calibration_seconds();
    let mut to_do = shard.share(cells(&options)?);
    to_do.retain(|cell| finished.iter().all(|done| done.cell != *cell));
    let costs = RunCosts::read(&options.fixtures)?;
    let time = costs.estimate(options.quick, &to_do, calibration_s);
    print(format!("{}\n", time.told(threads.current_num_threads())))?;

    let cells_done: Vec<_> = finished.iter().map(|done| done.cell.clone()).collect();
    let mut session = RegressSession::new(&options, shard, finished);
    if arguments.store_costs {
        ensure!(threads.current_num_threads() == 1, "--store-costs needs --threads 1");
        session = session.storing_costs(calibration_s);
    }
    threads.install(|| run_shard(&options, shard, &cells_done, &|done| session.add(done)))?;
    let done = session.finish()?;

    if shard.is_part() {
        let path = ShardResults::new(&options, shard, &done)?.write(&options.out)?;
        print(format!("shard {shard}: {} runs done, {}\n", done.len(), path.display()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let report = crate::regress::assemble(&options, shard, &done)?;
    report.write(&options.out)?;
    let code = show(&report, &options.out, !is_default && !arguments.all)?;
    if options.data.is_none() && !options.quick {
        print("Public recordings were left out: no --data and no WAYFIX_DATA.\n")?;
    }
    Ok(code)
}

/// Prints the report and judges it; `in_full` prints the figures of runs that pass too.
pub(super) fn show(report: &FullReport, out: &Path, in_full: bool) -> Result<ExitCode> {
    let style = TableStyle::of_stdout();
    print(if in_full { table::report(report, style) } else { failures(report, style) })?;
    print(format!("{0}/index.html  {0}/report.json\n", out.display()))?;
    let tally = report.tally();
    if (tally.passed, tally.failed) == (0, 0) {
        print("No figure has a bound: nothing is judged, and the exit code is 1.\n")?;
    }
    Ok(if tally.all_pass() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
