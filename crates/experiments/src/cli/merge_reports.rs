use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result};

use super::regress::show;
use crate::regress::{CampaignShard, ShardResults, assemble, join};

/// Merge the shares of a regression, run on several machines, into one report.
///
/// Each share is the output folder of one `wayfix-experiments regress --shard K/N`. The report, its figures and its exit code equal those of one
/// machine that runs everything, except for times. Shares of another campaign, and missing or repeated ones, are errors.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Output folders of all shares.
    #[arg(value_name = "DIR", required = true)]
    shares: Vec<PathBuf>,
    /// Folder for the report; the estimates of all shares are copied into it.
    #[arg(long, value_name = "DIR", default_value = "target/regress")]
    out: PathBuf,
    /// Folder of the stored logs and of the plans with the bounds.
    #[arg(long, value_name = "DIR", default_value = "fixtures")]
    fixtures: PathBuf,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let parts = arguments.shares.iter().map(|share| Ok((share.clone(), ShardResults::read(share)?)));
    let (options, done) = join(parts.collect::<Result<_>>()?, &arguments.fixtures, &arguments.out)?;
    let report = assemble(&options, CampaignShard::WHOLE, &done)?;
    fs::create_dir_all(&arguments.out)
        .with_context(|| format!("cannot create {}", arguments.out.display()))?;
    for log in report.suites.iter().flat_map(|suite| &suite.runs).filter_map(|run| run.log.as_deref()) {
        copy_estimates(log, &arguments.shares, &arguments.out)?;
    }
    report.write(&arguments.out)?;
    show(&report, &arguments.out, true)
}

/// Copies a log from whichever share has it.
fn copy_estimates(log: &str, shares: &[PathBuf], out: &Path) -> Result<()> {
    let Some(log) = Path::new(log).file_name() else { return Ok(()) }; // a share may come from any folder: its files stay there
    let target = out.join(log);
    let source = shares.iter().map(|share| share.join(log)).find(|path| path.exists() && *path != target);
    match source {
        Some(source) => fs::copy(&source, &target)
            .map(drop)
            .with_context(|| format!("cannot copy {} to {}", source.display(), target.display())),
        None => Ok(()),
    }
}
