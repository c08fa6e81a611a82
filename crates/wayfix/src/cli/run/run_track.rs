use std::{
    fs::File,
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    process::ExitCode,
    str::FromStr,
};

use anyhow::{Context, Result};
use wayfix_evaluation::report::ReportRun;
use wayfix_evaluation::terminal::{self, print, print_message};
use wayfix_sensor_log::{Log, LogFormat, LogOpenOptions};
use wayfix_system_core::{RunStep, Stopwatch, System, settings::from_toml};
use wayfix_systems::track::{
    self, InitialTargetRegion, TrackEstimateRecorder, TrackParams, TrackSystem, TrackerConfig,
    TrackingMethod, TrueBoxes, parse_box,
};
use wayfix_visual_tracking::{BoundingBox, HeadDetector};

use super::super::{
    common::Common, outputs::Outputs, parameter_file::read_toml, read_problems::add_read_problems,
};
use super::interrupt;
use crate::commented::commented;

/// Tracking: estimates the position of a target in every image, from its position in the first one.
///
/// A box is four numbers, left, top, width and height in pixels, or eight, the corners of a quadrangle, whose bounding box is used; separators are
/// commas, tabs or blanks. In a file of true boxes line k is frame k. A line 0,0,0,0 or NaN means that the target is outside the image. Frames after
/// the last line have no truth.
///
/// `iou_mean` is the mean overlap (intersection over union) with the true boxes over all frames from the first one on. `success_auc` is the share of
/// frames with more overlap than each of 0, 0.05, …, 1, averaged. `precision_20px` is the share of frames with a centre error of at most 20 pixels.
/// A frame has overlap 0 if the tracker reports the target lost (`n_lost`), or if it cannot be read or is refused (`n_frames_without_estimate`).
/// `false_tracked_share` is the share of the frames with overlap below 0.2 reported as tracked, `false_lost_share` that of the frames with overlap
/// 0.5 or more reported as lost. Frames without a true box do not count. Without --truth these figures are absent. `frame_mean_ms` is the computing
/// time of the tracker, without decoding.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// A folder of pictures, JPEG or PNG, in the order of their names.
    #[arg(long, value_name = "DIR", required_unless_present_any = ["log", "print_params"], conflicts_with = "log")]
    frames: Option<PathBuf>,
    /// A log with images, an MCAP file, instead of --frames; several are the files of one recording.
    #[arg(long, value_name = "PATH")]
    log: Vec<PathBuf>,
    /// Position of the target in the first frame: x,y,w,h or eight numbers [default: the first true box].
    #[arg(long, value_name = "BOX", allow_hyphen_values = true, required_unless_present_any = ["init_mask", "learn_from", "truth", "print_params"])]
    init: Option<BoxArgument>,
    /// The same as a mask image of the size of the frames, in which the target is not black; it gives `contour` the exact outline.
    #[arg(long, value_name = "FILE", conflicts_with = "init")]
    init_mask: Option<PathBuf>,
    /// Detect a head instead of --init: a folder of pictures from which its colours and rim are learned. The tracker starts in the first frame with a head.
    #[arg(long, value_name = "DIR", requires = "learn_truth", conflicts_with_all = ["init", "init_mask"])]
    learn_from: Option<PathBuf>,
    /// True boxes of --learn-from, one line a picture.
    #[arg(long, value_name = "FILE", requires = "learn_from")]
    learn_truth: Option<PathBuf>,
    /// True boxes, one line a frame.
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// The tracker.
    #[arg(long, value_enum, value_name = "NAME", default_value = "box")]
    method: TrackingMethod,
    /// The head and contour trackers as published by Andrade-Cetto 2005, without the additions.
    #[arg(long, conflicts_with = "params")]
    as_published: bool,
    #[command(flatten)]
    common: Common,
}

const EXAMPLES: &str = "\
Examples:
  wayfix run track --frames David/img --truth David/groundtruth_rect.txt
  wayfix run track --frames holiday --init 120,80,40,56 --out results
  wayfix run track --frames snail --init-mask snail.png --method contour
  wayfix run track --frames today --learn-from yesterday --learn-truth yesterday.txt --method head
  wayfix run track --log camera.mcap --init 120,80,40,56 --json";

/// The boxes beside the report, in the form of true ones.
const BOXES: &str = "boxes.txt";

#[derive(Clone, Copy, Debug)]
struct BoxArgument(BoundingBox);

impl FromStr for BoxArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = parse_box(text).map_err(|error| error.to_string())?;
        found.map(Self).ok_or_else(|| "a box at the beginning needs an extent".to_owned())
    }
}

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let params = match &arguments.common.params {
        Some(path) => read_toml(path, "track", from_toml::<TrackParams>)?,
        None if arguments.as_published => TrackParams::as_published(),
        None => TrackParams::default(),
    };
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let truth = arguments.truth.as_deref().map(true_boxes).transpose()?.unwrap_or_default();
    let detector = arguments.detector(&params)?;
    let (mut log, rate_hz) = arguments.open()?;
    let origin = log.meta().first_format();
    let mut outputs = Outputs::open("track", &arguments.common)?;
    let mut estimates = open_estimates(&mut outputs, origin)?;

    let stopwatch = Stopwatch::start();
    let init = match &arguments.init_mask {
        Some(path) => Some(InitialTargetRegion::read_mask(path)?),
        None => arguments.init.map(|init| InitialTargetRegion::Box(init.0)),
    };
    let setup = TrackerConfig { method: arguments.method, params, init, detector, truth, rate_hz };
    let system = TrackSystem::new(setup, arguments.common.seed);
    let bar = terminal::counter("tracking");
    let track = track::run(system, &mut log, |RunStep { system, record, stop, .. }| {
        if let Some(estimates) = &mut estimates {
            estimates.observe(record, system);
        }
        stop.set(interrupt::is_requested());
        bar.set_position(system.n_frames() as u64);
    });
    bar.finish_and_clear();
    if !log.report().is_clean() {
        print_message(log.report());
    }
    let mut track = track?;
    let warnings = add_read_problems(track.system.events(), log.report());

    let name = log.meta().source.display().to_string();
    let seconds = stopwatch.elapsed().as_secs_f64();
    let run = ReportRun { name, seconds, warnings, ..track::summarize(&mut track) };
    run.notes.iter().for_each(|note| print_message(format!("note: {note}")));
    if let Some(estimates) = estimates {
        estimates.finish(track.system.n_frames())?;
    }
    outputs.show(run, || Ok(track::plots(&track.run_history)?))?;
    Ok(ExitCode::SUCCESS)
}

fn true_boxes(path: &Path) -> Result<TrueBoxes> {
    TrueBoxes::read(path).with_context(|| format!("true boxes in {} are not usable", path.display()))
}

impl Arguments {
    fn detector(&self, params: &TrackParams) -> Result<Option<HeadDetector>> {
        let (Some(folder), Some(truth)) = (&self.learn_from, &self.learn_truth) else { return Ok(None) };
        let options = LogOpenOptions { format: Some(LogFormat::Images), ..LogOpenOptions::default() };
        let (rate_hz, truth) = (Some(options.frame_rate_hz), true_boxes(truth)?);
        let mut log = wayfix_sensor_log::open(folder, &options)?;
        let detector = track::learn_head(&mut log, &truth, rate_hz, .., &params.head, folder)?;
        if !log.report().is_clean() {
            print_message(log.report());
        }
        Ok(Some(detector))
    }

    /// The log, and the frames a second of a folder.
    fn open(&self) -> Result<(Log, Option<f64>)> {
        let mut options = LogOpenOptions::default();
        match (&self.frames, self.log.as_slice()) {
            (Some(folder), _) => {
                options.format = Some(LogFormat::Images);
                let rate_hz = Some(options.frame_rate_hz);
                Ok((wayfix_sensor_log::open(folder, &options)?, rate_hz))
            }
            (None, []) => anyhow::bail!("give --frames or --log"),
            (None, paths) => Ok((wayfix_sensor_log::open_all(paths, &options)?, None)),
        }
    }
}

fn open_estimates(outputs: &mut Outputs<'_>, origin: LogFormat) -> Result<Option<TrackEstimateRecorder>> {
    let sinks = outputs.sinks()?;
    let boxes: Box<dyn Write> = match outputs.file(BOXES) {
        Some(path) => {
            let file = File::create(&path).with_context(|| format!("cannot create {}", path.display()))?;
            Box::new(BufWriter::new(file))
        }
        None if sinks.is_empty() => return Ok(None),
        None => Box::new(io::sink()),
    };
    let recorder = TrackEstimateRecorder::new(sinks, boxes, origin)?;
    Ok(Some(if outputs.has_echo() { recorder } else { recorder.without_echo() }))
}
