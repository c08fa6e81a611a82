use std::{path::PathBuf, process::ExitCode};

use anyhow::{Context, Result};

use super::{output::print, progress};
use crate::{
    regress::{Options, n_runs, regress, suites},
    report::{table, table::TableStyle},
};

/// Run every system on the stored logs, and on public recordings where they are at hand, and judge the figures.
///
/// Each figure has bounds, and each bound a source: a paper, another program, or an argument (fixtures/SUITE.toml). Ends with 0 when
/// every figure is within its bounds, else with 1. OUT/index.html shows trajectories, maps and figures.
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
    /// Stored logs and short experiments only.
    #[arg(long)]
    quick: bool,
    /// Take the figures of the stored logs as right from now on; look at the change first.
    #[arg(long)]
    bless: bool,
    /// Threads [default: one a core]. The figures do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let all = || suites::names().into_iter().map(str::to_owned).collect();
    let options = Options {
        suites: if arguments.suites.is_empty() { all() } else { arguments.suites },
        fixtures: arguments.fixtures,
        data: arguments.data,
        out: arguments.out,
        seed: arguments.seed,
        quick: arguments.quick,
        bless: arguments.bless,
    };
    let bar = progress::bar(n_runs(&options)?, "regress");
    let done = |name: &str| {
        bar.set_message(name.to_owned());
        bar.inc(1);
    };
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.unwrap_or(0)).build();
    let report = threads.context("cannot start the threads")?.install(|| regress(&options, &done))?;
    bar.finish_and_clear();

    report.write(&options.out)?;
    print(table::report(&report, TableStyle::of_stdout()))?;
    if options.data.is_none() && !options.quick {
        print("Public recordings were left out: no --data and no WAYFIX_DATA.\n")?;
    }
    print(format!("{0}/index.html  {0}/report.json\n", options.out.display()))?;
    Ok(if report.tally().all_pass() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
