use std::{path::Path, process::ExitCode};

use anyhow::{Result, bail, ensure};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use wayfix_evaluation::{report::ReportRun, terminal::print_message};
use wayfix_sensor_log::LogFormat;
use wayfix_slam_system::ranges;
use wayfix_system_core::{EventCounts, Stopwatch};
use wayfix_table_log::RangeRecording;

use super::{
    super::{input::name_of, outputs::Outputs, read_problems::add_read_problems},
    run_slam::{self, EstimatorName},
};

/// How a log for `run slam` is stored.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) enum SlamLogFormat {
    /// As `wayfix info` reads it.
    Log(LogFormat),
    /// A folder of tables with ranges to radio beacons.
    Plaza,
}

/// Such a format by its name; for a mistyped name the error gives the most similar one.
pub(in crate::cli) fn slam_log_format() -> impl TypedValueParser<Value = SlamLogFormat> {
    let names = LogFormat::ALL.map(LogFormat::name).into_iter().chain([PLAZA]);
    PossibleValuesParser::new(names).try_map(|name| match name.as_str() {
        PLAZA => Ok(SlamLogFormat::Plaza),
        name => name.parse::<LogFormat>().map(SlamLogFormat::Log),
    })
}

const PLAZA: &str = "plaza";

/// The folder, if the log is one of ranges.
pub(in crate::cli) fn folder(arguments: &run_slam::Arguments) -> Option<&Path> {
    let [folder] = arguments.log.as_slice() else { return None };
    let is_ranges = match arguments.format {
        Some(format) => matches!(format, SlamLogFormat::Plaza),
        None => RangeRecording::is_in(folder),
    };
    is_ranges.then_some(folder)
}

/// `wayfix run slam --estimator smoother` on ranges without bearings.
pub(in crate::cli) fn main(arguments: &run_slam::Arguments, folder: &Path) -> Result<ExitCode> {
    check(arguments)?;
    let mut recording = RangeRecording::read(folder)?;
    if !recording.report.is_clean() {
        print_message(&recording.report);
    }
    let truth = arguments.truth.put_into(std::mem::take(&mut recording.truth))?;
    let outputs = Outputs::open("slam", &arguments.common)?;
    let stopwatch = Stopwatch::start();
    let mut run = ranges::run(&recording, &truth)?;
    let mut events: EventCounts = std::mem::take(&mut run.events);
    let warnings = add_read_problems(&mut events, &recording.report);
    run.events = events;
    let summary = ReportRun {
        name: name_of(&arguments.log),
        seconds: stopwatch.elapsed().as_secs_f64(),
        warnings,
        ..ranges::summarize(&run)
    };
    summary.notes.iter().for_each(print_message);
    outputs.show(summary, || Ok(ranges::plots(&run)?))?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses options that have no effect here.
fn check(arguments: &run_slam::Arguments) -> Result<()> {
    if arguments.estimator == EstimatorName::Ekf {
        bail!(
            "ranges without bearings need --estimator smoother: a single range does not start a landmark of the EKF"
        );
    }
    ensure!(
        arguments.common.params.is_none() && !arguments.common.print_params,
        "runs on ranges have no parameters: noise, bias and scale come from the log"
    );
    ensure!(
        arguments.save.is_none() && arguments.resume.is_none() && !arguments.observability,
        "--save, --resume and --observability are for logs of range-bearing detections and of scans: ranges are one batch"
    );
    ensure!(arguments.relations.is_none(), "--relations is for logs of scans");
    ensure!(arguments.graph_out.is_none(), "--graph-out is for logs of range-bearing detections");
    ensure!(
        arguments.profile.is_none(),
        "--profile is for logs of range-bearing detections; noise comes from the log here"
    );
    Ok(())
}
