use std::{borrow::Cow, fs, path::PathBuf, process::ExitCode};

use anyhow::{Context, Result, ensure};
use nalgebra::DefaultAllocator;
use serde::{Serialize, de::DeserializeOwned};
use wayfix_evaluation::{
    plot::{PlotError, SvgPlot},
    report::ReportRun,
    terminal::{self, print, print_message},
};
use wayfix_sensor_log::{LogFormat, LogOpenOptions, ReadReport, Record};
use wayfix_slam_ekf::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};
use wayfix_slam_system::{
    points::{self, PointSlamParams, RobotProfile, SavedPointMap},
    slam::{
        AssociationRule, FrontEnd, FrontEndState, PeriodicStateSaver, SlamEstimateRecorder, SlamRun,
        SlamState, SlamSystem, Smoothing, StateOf,
    },
};
use wayfix_system_core::{RunStep, Stopwatch};

use super::super::{
    common::Common,
    input::{Topics, name_of},
    outputs::Outputs,
    parameter_file::read_toml,
    read_problems::{add_read_problems, read_all, read_overview, whole},
    truth::TruthFile,
};
use super::{
    interrupt,
    run_ranges::{self, SlamLogFormat},
    run_walls,
};
use crate::commented::commented;

/// EKF-SLAM: the path of the robot and a map of landmarks, from odometry and range-bearing detections or laser scans.
///
/// If the log has true poses, the run starts at the true pose where odometry starts, and the figures include the errors. `ate_rmse_m` is the RMS
/// position error, `ate_aligned_rmse_m` the same after the best rigid fit of the path; `landmark_…` are those of the map. `nees_mean` is 3 for a
/// consistent filter, and far above 3 for an overconfident one. Without truth these figures are absent.
///
/// `n_rejected` counts rejected measurements: outside the gate, repeated in one scan, unusable, or back in time. `step_…_us` is the computing time
/// of one scan.
///
/// In logs of laser scans the landmarks are walls, and the parameters are different (`--print-params` with the log shows them). If such a log has no
/// true poses, the estimates of another program in the log replace them. A ROS 2 bag gives the pose of the laser by its transforms, unless the
/// parameters set it. `--relations` adds the errors of known relations.
///
/// Unusable records are skipped, counted in the events and listed on standard error; the run continues.
/// The exit code is 1 if nothing could be estimated, 2 if the command line is wrong.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// The log: an MCAP file, which may be a ROS 2 bag, the folder of a UTIAS or Victoria Park set, a text file of range-bearing lines, or laser scans of CARMEN or JSON.
    ///
    /// Repeat it for the MCAP files of one recording; for a split ROS 2 bag give the folder.
    #[arg(long, value_name = "PATH", required_unless_present = "print_params")]
    pub(in crate::cli) log: Vec<PathBuf>,
    /// Input format [default: detected from the content].
    #[arg(long, value_parser = run_ranges::slam_log_format())]
    pub(in crate::cli) format: Option<SlamLogFormat>,
    /// The estimator: a filter, or least squares over all poses of a window.
    #[arg(long, value_enum, value_name = "NAME", default_value = "ekf")]
    pub(in crate::cli) estimator: EstimatorName,
    /// Number of the robot, for sets with several robots.
    #[arg(long, value_name = "N")]
    pub(in crate::cli) robot: Option<u32>,
    #[command(flatten)]
    pub(in crate::cli) topics: Topics,
    #[command(flatten)]
    pub(in crate::cli) truth: TruthFile,
    /// Association of detections with landmarks [default: known where the log has identities, else jcbb].
    #[arg(long, value_name = "RULE")]
    pub(in crate::cli) association: Option<AssociationRule>,
    /// Robot profile: the default noise and timing [default: by the format of the log, else generic].
    #[arg(long)]
    pub(in crate::cli) profile: Option<RobotProfile>,
    /// A file of known relations between poses, for logs of scans: `t1 t2 x y z roll pitch yaw` lines of the Freiburg SLAM benchmark.
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) relations: Option<PathBuf>,
    /// File to save map and filter to, at the end and every `--save-every` seconds.
    ///
    /// The file is replaced as a whole: a power failure leaves the old or the new one.
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) save: Option<PathBuf>,
    /// Seconds of the log's time between two saves.
    #[arg(long, value_name = "SECONDS", requires = "save", value_parser = not_negative)]
    pub(in crate::cli) save_every: Option<f64>,
    /// Continue from a saved map, with the later records of the log.
    ///
    /// Records up to the stamp of the save are skipped; figures and events are those of the rest.
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) resume: Option<PathBuf>,
    /// Report the directions of the map that no measurement has constrained.
    ///
    /// Detections cannot constrain position and heading of the whole map; anchors and external sensors can.
    #[arg(long)]
    pub(in crate::cli) observability: bool,
    /// File for the least squares problem of the batch, with the associations of the filter: text, for logs of points.
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) graph_out: Option<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) common: Common,
}

/// An estimator of SLAM.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(in crate::cli) enum EstimatorName {
    /// Extended Kalman filter.
    Ekf,
    /// Sparse least squares: a window of 60 s for points, in which pairings of the filter can be taken back; one batch for ranges without bearings.
    Smoother,
}

const EXAMPLES: &str = "\
Examples:
  wayfix run slam --log slam_100.txt                                    figures as a table
  wayfix run slam --log slam_100.txt --association nn --json            identities not used
  wayfix run slam --log MRCLAM_Dataset7 --robot 1 --out results         results/index.html
  wayfix run slam --log my.mcap --print-params > my.toml                a file to edit, for
  wayfix run slam --log my.mcap --params my.toml
  wayfix run slam --log monday.mcap --save floor.map --save-every 10
  wayfix run slam --log rosbag2_0.mcap --topic /scan_front              walls, from the laser and /odom
  wayfix run slam --log plaza --estimator smoother                      ranges to beacons of unknown place
  wayfix run slam --log tuesday.mcap --resume floor.map --save floor.map

A parameter file has only the keys that differ from the defaults, for instance
  [sensor]
  range_sigma = 0.10      # m
  bearing_sigma = 0.03    # rad";

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    if arguments.log.is_empty() {
        print(commented(&params(&arguments, RobotProfile::Generic)?)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    ensure!(
        arguments.estimator == EstimatorName::Ekf || arguments.graph_out.is_none(),
        "--graph-out needs --estimator ekf: it writes the batch that the filter is compared with"
    );
    if let Some(folder) = run_ranges::folder(&arguments) {
        return run_ranges::main(&arguments, folder);
    }
    let options = LogOpenOptions {
        format: arguments.format.and_then(|format| match format {
            SlamLogFormat::Log(format) => Some(format),
            SlamLogFormat::Plaza => None,
        }),
        robot: arguments.robot,
        topics: arguments.topics.topics.clone(),
        ..LogOpenOptions::default()
    };
    let open = || wayfix_sensor_log::open_all(&arguments.log, &options);
    let log = open()?;
    let meta = log.meta().clone();
    ensure!(
        arguments.robot.is_none() || meta.first_format() == LogFormat::Utias,
        "--robot is for folders of UTIAS sets, which have several robots"
    );
    let is_kept = arguments.truth.truth.is_some();
    let overview = if is_kept {
        let (records, read) = read_all(log);
        whole(arguments.truth.put_into(records)?, read)
    } else {
        read_overview(open, 0)?
    };
    if run_walls::is_for(&overview.records) {
        let input = run_walls::Input { overview, is_kept, origin: meta.first_format() };
        return run_walls::main(&arguments, input, &open);
    }
    ensure!(arguments.relations.is_none(), "--relations is for logs of scans; this log has none");
    let origin = meta.first_format();
    let params = params(&arguments, RobotProfile::of_log(&meta))?;
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let saved: Option<SavedPointMap> = arguments.saved_map()?;
    execute(
        &arguments,
        (origin, overview.n_records, &overview.read),
        |observe| {
            let known = &overview.records;
            let records: Box<dyn Iterator<Item = Cow<'_, Record>>> = if is_kept {
                Box::new(known.iter().map(Cow::Borrowed))
            } else {
                Box::new(open()?.map(Cow::Owned))
            };
            match saved {
                Some(saved) => points::run_on(saved, known, records, &params, observe),
                None => points::run_streamed(known, records, &params, observe),
            }
        },
        |run| Ok(points::summarize(run)),
        points::plots,
    )
}

/// Runs EKF-SLAM with one kind of landmark, and shows and saves the result. `input` is the format, the number of records and the result of
/// reading them.
pub(super) fn execute<F: FrontEnd, T>(
    arguments: &Arguments,
    (origin, n_records, read): (LogFormat, usize, &ReadReport),
    run: impl FnOnce(&mut dyn FnMut(RunStep<'_, SlamSystem<F>>)) -> Result<SlamRun<F, T>>,
    summarize: impl FnOnce(&mut SlamRun<F, T>) -> Result<ReportRun>,
    plots: impl FnOnce(&SlamRun<F, T>) -> Result<Vec<SvgPlot>, PlotError>,
) -> Result<ExitCode>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
    StateOf<F>: Serialize + DeserializeOwned,
{
    let mut outputs = Outputs::open("slam", &arguments.common)?;
    let mut estimates: Option<SlamEstimateRecorder<F>> = outputs.estimates(origin)?;
    let stopwatch = Stopwatch::start();
    let mut saver = arguments.save.clone().map(|path| PeriodicStateSaver::new(path, arguments.save_every));
    let bar = terminal::bar(n_records, "EKF-SLAM");
    let slam = run(&mut |RunStep { system, record, next, stop }: RunStep<'_, SlamSystem<F>>| {
        if let Some(estimates) = &mut estimates {
            estimates.observe(record, system);
        }
        if let Some(saver) = &mut saver {
            saver.observe(record, next, || system.save());
        }
        stop.set(interrupt::is_requested());
        bar.inc(1);
    });
    bar.finish_and_clear();
    let mut slam = slam?;
    if let Some(saver) = saver {
        saver.finish(&slam.system.save()).context("cannot save the map")?;
    }
    if let Some(path) = &arguments.graph_out {
        let graph = slam.smoothed.as_ref().and_then(|smoothed| smoothed.graph.as_ref());
        let graph =
            graph.context("there is no batch of this run: --graph-out needs points and --estimator ekf")?;
        let graph = graph.as_ref().map_err(Clone::clone).context("--graph-out cannot write this batch")?;
        fs::write(path, graph).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let warnings = add_read_problems(slam.events(), read);
    let run = ReportRun {
        name: name_of(&arguments.log),
        seconds: stopwatch.elapsed().as_secs_f64(),
        warnings,
        ..summarize(&mut slam)?
    };
    run.notes.iter().for_each(print_message);
    if let Some(estimates) = estimates {
        estimates.finish()?;
    }
    outputs.show(run, || Ok(plots(&slam)?))?;
    Ok(ExitCode::SUCCESS)
}

impl Arguments {
    /// The map of `--resume`.
    pub(super) fn saved_map<R, L, S: FrontEndState>(&self) -> Result<Option<SlamState<R, L, S>>>
    where
        SlamState<R, L, S>: Serialize + DeserializeOwned,
    {
        let read = |path: &PathBuf| {
            SlamState::read(path).with_context(|| format!("cannot go on from {}", path.display()))
        };
        self.resume.as_ref().map(read).transpose()
    }
}

/// The parameters; `usual` is the profile unless the command line names one.
fn params(arguments: &Arguments, usual: RobotProfile) -> Result<PointSlamParams> {
    let profile = arguments.profile.unwrap_or(usual);
    let mut params = match &arguments.common.params {
        Some(path) => read_toml(path, "slam", |text| PointSlamParams::from_toml(text, profile))?
            .validated()
            .with_context(|| format!("parameters in {} are not usable", path.display()))?,
        None => PointSlamParams::of(profile),
    };
    params.association = arguments.association.or(params.association);
    params.record_observability = arguments.observability;
    params.record_graph = arguments.graph_out.is_some();
    params.smoothing = match arguments.estimator {
        EstimatorName::Ekf => Smoothing::Reference,
        EstimatorName::Smoother => Smoothing::FixedLag,
    };
    Ok(params)
}

fn not_negative(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if seconds >= 0.0 { Ok(seconds) } else { Err("must be 0 or more".to_owned()) }
}
