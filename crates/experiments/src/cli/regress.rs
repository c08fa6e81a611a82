use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result};
use wayfix_evaluation::terminal::{self, print};

use crate::regress::{CampaignShard, RegressOptions, ShardResults, assemble, cells, run_shard, suites};
use wayfix_evaluation::report::{FullReport, table, table::TableStyle};

/// Run every system on the stored logs, and on public recordings if available, and compare the figures with their bounds.
///
/// Each figure has bounds, and each bound a source: a paper, another program, or an argument (fixtures/SUITE.toml). The exit code is 0 if every
/// figure is within its bounds, else 1. OUT/index.html shows trajectories, maps and figures.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Suites to run; all by default.
    #[arg(value_name = "SUITE", value_parser = suites::names())]
    suites: Vec<String>,
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
    /// Do the K-th of N shares of the work and write OUT/part.json; `wayfix-experiments merge-reports` makes one report of all shares.
    #[arg(long, value_name = "K/N", default_value_t = CampaignShard::WHOLE, hide_default_value = true, conflicts_with = "bless")]
    shard: CampaignShard,
    /// Stored logs and short experiments only.
    #[arg(long)]
    quick: bool,
    /// Store the present figures of the stored logs as the reference; review the change first.
    #[arg(long)]
    bless: bool,
    /// Threads [default: one a core]. The figures do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let all = || suites::names().into_iter().map(str::to_owned).collect();
    let options = RegressOptions {
        suites: if arguments.suites.is_empty() { all() } else { arguments.suites },
        fixtures: arguments.fixtures,
        data: arguments.data,
        out: arguments.out,
        seed: arguments.seed,
        n_seeds: arguments.seeds,
        quick: arguments.quick,
        bless: arguments.bless,
    };
    let shard = arguments.shard;
    let n_mine = (0..cells(&options)?.len()).filter(|index| shard.takes(*index)).count();
    let bar = terminal::bar(n_mine, "regress");
    let done = |name: &str| {
        bar.set_message(name.to_owned());
        bar.inc(1);
    };
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.unwrap_or(0)).build();
    let done = threads.context("cannot start the threads")?.install(|| run_shard(&options, shard, &done))?;
    bar.finish_and_clear();

    if shard.is_part() {
        let path = ShardResults::new(&options, shard, done)?.write(&options.out)?;
        print(format!("shard {shard}: {n_mine} runs done, {}\n", path.display()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let report = assemble(&options, &done)?;
    let code = show(&report, &options.out)?;
    if options.data.is_none() && !options.quick {
        print("Public recordings were left out: no --data and no WAYFIX_DATA.\n")?;
    }
    Ok(code)
}

/// Writes the report, prints it, and judges it.
pub(super) fn show(report: &FullReport, out: &Path) -> Result<ExitCode> {
    report.write(out)?;
    print(table::report(report, TableStyle::of_stdout()))?;
    print(format!("{0}/index.html  {0}/report.json\n", out.display()))?;
    Ok(if report.tally().all_pass() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
