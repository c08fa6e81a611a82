use std::{path::PathBuf, process::ExitCode};

use anyhow::{Result, ensure};
use wayfix_evaluation::report::ReportRun;
use wayfix_evaluation::terminal::{self, print, print_message};
use wayfix_line_extract::LineExtractionParams;
use wayfix_sensor_log::{LogFormat, LogOpenOptions};
use wayfix_system_core::{RunStep, Stopwatch, System, drive};
use wayfix_systems::lines::{self, LineEstimateRecorder, LineExtractionSystem};

use super::super::{
    common::Common,
    input::{Topics, log_format, name_of},
    outputs::Outputs,
    parameter_file::read_toml,
    read_problems::add_read_problems,
};
use super::interrupt;
use crate::commented::commented;

/// Walls: the straight segments in every laser scan of a log, with their ends.
///
/// The figures are the numbers of scans and of skipped scans (`n_skipped`), walls per scan, the RMS distance of the echoes from their walls, and the
/// computing time. The events and standard error have the reasons of skipped scans. If the log has true walls, the figures include the numbers of
/// walls within 2σ of the true ones, of false walls, and of true walls found.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// The log: CARMEN, scans as JSON, or MCAP, which may be a ROS 2 bag; text may be compressed with gzip.
    ///
    /// Repeat it for the MCAP files of one recording; for a split ROS 2 bag give the folder.
    #[arg(long, value_name = "PATH", required_unless_present = "print_params")]
    log: Vec<PathBuf>,
    /// Input format: carmen, scan-json or mcap [default: detected from the content].
    #[arg(long, value_parser = log_format(), hide_possible_values = true)]
    format: Option<LogFormat>,
    #[command(flatten)]
    topics: Topics,
    #[command(flatten)]
    common: Common,
}

const EXAMPLES: &str = "\
Examples:
  wayfix run lines --log intel-corrected.log.gz
  wayfix run lines --log my.mcap --out results
  wayfix run lines --log rosbag2_0.mcap --topic /scan_rear";

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let params = match &arguments.common.params {
        Some(path) => read_toml(path, "lines", |text| toml::from_str(text))?,
        None => LineExtractionParams::default(),
    };
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut system = LineExtractionSystem::new(params)?;
    let options = LogOpenOptions {
        format: arguments.format,
        topics: arguments.topics.topics,
        ..LogOpenOptions::default()
    };
    let mut log = wayfix_sensor_log::open_all(&arguments.log, &options)?;
    let origin = log.meta().first_format();

    let mut outputs = Outputs::open("lines", &arguments.common)?;
    let mut walls: Option<LineEstimateRecorder> = outputs.estimates(origin)?;
    let stopwatch = Stopwatch::start();
    let bar = terminal::counter("walls");
    drive(&mut system, log.by_ref(), |RunStep { system, record, stop, .. }| {
        if let Some(walls) = &mut walls {
            walls.observe(record, system);
        }
        stop.set(interrupt::is_requested());
        bar.set_position(system.n_scans());
    });
    bar.finish_and_clear();
    let read = log.report();
    if !read.is_clean() {
        print_message(read);
    }
    ensure!(system.n_scans() > 0, "{}: no laser scan in the log", name_of(&arguments.log));
    let warnings = add_read_problems(system.events(), read);
    ensure!(system.latest().is_some(), "{}: no laser scan could be used", name_of(&arguments.log));

    let name = name_of(&arguments.log);
    let seconds = stopwatch.elapsed().as_secs_f64();
    let run = ReportRun { name, seconds, warnings, ..lines::summarize(&mut system) };
    if let Some(walls) = walls {
        walls.finish()?;
    }
    outputs.show(run, || Ok(lines::plots(&system)?))?;
    Ok(ExitCode::SUCCESS)
}
