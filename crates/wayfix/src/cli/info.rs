use std::{path::PathBuf, process::ExitCode};

use anyhow::Result;
use wayfix_sensor_log::{Format, LogSummary, OpenOptions};

/// Tell what a log holds: records, rates, landmarks, robots, problems.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The log.
    path: PathBuf,
    /// How it is stored: utias, range-bearing, tum, mcap. Detected when not given.
    #[arg(long)]
    format: Option<Format>,
    /// Which robot, in sets of several.
    #[arg(long)]
    robot: Option<u32>,
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let options = OpenOptions { format: arguments.format, robot: arguments.robot, ..OpenOptions::default() };
    print!("{}", LogSummary::of(wayfix_sensor_log::open(&arguments.path, &options)?));
    Ok(ExitCode::SUCCESS)
}
