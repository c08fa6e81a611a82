use std::{borrow::Cow, fs, path::PathBuf, process::ExitCode, str::FromStr, sync::Arc};

use anyhow::{Context, Result, ensure};
use wayfix_color_model::LightingPriors;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::terminal::{self, print};
use wayfix_evaluation::{plot::SvgPlot, report::ReportRun};
use wayfix_sensor_log::{LogOpenOptions, ReadReport, Record};
use wayfix_system_core::{LogOverview, RunStep, Stopwatch, System, without_odometry_delay};
use wayfix_systems::color::{
    self, ColorEstimateRecorder, ColorRun, ColorRunSetup, ColorSystemParams, ParticleSnapshots,
    RecordIterator, StartPose, priors,
};

use super::super::{
    common::Common,
    input::{Topics, name_of},
    outputs::Outputs,
    parameter_file::read_toml,
    read_problems::{add_read_problems, add_read_report, read_all, read_overview, whole},
    truth::TruthFile,
};
use super::interrupt;
use crate::commented::commented;

/// Adaptive colour localization: estimates the robot's pose on a coloured field, and the effect of the light on the colours.
///
/// The log holds camera images, the camera's calibration, its pose from the joint angles, and odometry; the map holds the colours of the surfaces.
/// Colours need no calibration: priors describe dark and bright light, and the filter estimates the actual one.
///
/// If the log holds true poses, the search starts near the first one (0.5 m and 17° in standard deviation). The figures then include the errors of the
/// estimate, `position_mean_m` and `heading_mean_deg`. `dead_reckoning_position_error_mean_m` is that of odometry alone from the same start. With true
/// labels, `classification_rate` is the share of labelled pixels that are classified correctly. Without truth these figures are absent.
///
/// Unusable records are skipped, counted in the events and listed on standard error; the run continues.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// The log, an MCAP file; it may be a ROS 2 bag with rectified images and the transforms from the robot to its camera.
    ///
    /// Repeat it for the files of one recording; for a split ROS 2 bag give the folder.
    #[arg(long, value_name = "PATH", required_unless_present_any = ["write_priors", "print_params"])]
    log: Vec<PathBuf>,
    #[command(flatten)]
    topics: Topics,
    /// A log of a second camera of the robot: its images, calibration and mount, on the same clock; it may be the same bag with `--second-topic`.
    ///
    /// Its images correct the pose between those of the first camera, at which poses are written. The search for an unknown place uses the first camera alone. Colours and
    /// light are estimated for each camera. An MCAP of ours has its own `/camera/info` and `/camera/mount`.
    #[arg(long, value_name = "PATH")]
    second_camera: Vec<PathBuf>,
    /// The topic of the second camera's images in a ROS 2 bag; repeat it for that of its calibration.
    #[arg(long, value_name = "NAME", requires = "second_camera")]
    second_topic: Vec<String>,
    #[command(flatten)]
    truth: TruthFile,
    /// The map: coloured polygons and posts, TOML or JSON.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["write_priors", "print_params"])]
    map: Option<PathBuf>,
    /// Priors of the colours, one Gaussian per kind of light: JSON from `wayfix learn-priors`, or `broad` for the colours of the four-legged league under any lamp and
    /// any camera [default: these colours in simulated halls, dark and bright].
    #[arg(long, value_name = "FILE|broad")]
    priors: Option<PriorsArgument>,
    /// Write the built-in priors to a file and exit: a template for your own.
    #[arg(long, value_name = "FILE")]
    write_priors: Option<PathBuf>,
    /// Start pose at the first image: `anywhere`, or x,y,heading in metres and degrees [default: near the first true pose, else
    /// anywhere].
    #[arg(long, value_name = "WHERE", allow_hyphen_values = true)]
    start: Option<StartArgument>,
    /// The localizer as published by Schulz & Fox, without the additions: no search, no relocalization, no occlusion, no shade. It replaces `[localizer]` of --params, but
    /// for odometry and camera, and `unseen_colors`, and removes `[feature_likelihood]`; variances and drift of the light stay.
    #[arg(long)]
    as_published: bool,
    #[command(flatten)]
    common: Common,
}

const EXAMPLES: &str = "\
Examples:
  wayfix run color --log fixtures/color_dark.mcap --map fixtures/four-legged-field.toml
  wayfix run color --log my.mcap --map my-field.toml --start anywhere --out results
  wayfix run color --log nao --topic /top/image --second-camera nao --second-topic /bottom/image --map my-field.toml
  wayfix run color --print-params > my.toml
  wayfix run color --write-priors priors.json";

#[derive(Clone, Debug)]
enum PriorsArgument {
    Broad,
    File(PathBuf),
}

impl From<std::ffi::OsString> for PriorsArgument {
    fn from(text: std::ffi::OsString) -> Self {
        if text == "broad" { Self::Broad } else { Self::File(text.into()) }
    }
}

impl PriorsArgument {
    fn read(&self) -> Result<LightingPriors> {
        match self {
            Self::Broad => priors::broad(),
            Self::File(path) => priors::read(path),
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct StartArgument(StartPose);

impl FromStr for StartArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "anywhere" {
            return Ok(Self(StartPose::Anywhere));
        }
        let numbers: Vec<f64> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
        match numbers[..] {
            [x, y, heading] if numbers.iter().all(|number| number.is_finite()) => {
                Ok(Self(StartPose::Near(Pose2::new(x, y, heading.to_radians()))))
            }
            _ => {
                Err("give `anywhere`, or x,y,heading in metres and degrees, for instance -1.5,0.3,90"
                    .to_owned())
            }
        }
    }
}

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    if let Some(path) = &arguments.write_priors {
        let text = serde_json::to_string_pretty(&priors::built_in()?)? + "\n";
        fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut params = match &arguments.common.params {
        Some(path) => read_toml(path, "color", |text| toml::from_str(text))?,
        None => ColorSystemParams::default(),
    };
    if arguments.as_published {
        params.set_published();
    }
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let map = Arc::new(color::read_map(arguments.map.as_deref().context("give --map")?)?);
    let priors = arguments.priors.as_ref().map_or_else(priors::built_in, PriorsArgument::read)?;
    ensure!(
        priors.colors() == map.colors(),
        "the map has the colours {:?}, the priors {:?}: they must be the same, in the same order",
        map.colors(),
        priors.colors()
    );
    let bank = priors::bank(&priors, &params)?;
    let options = LogOpenOptions { topics: arguments.topics.topics, ..LogOpenOptions::default() };
    let open = || wayfix_sensor_log::open_all(&arguments.log, &options);
    let log = open()?;
    let origin = log.meta().first_format();
    let (second_camera, second_read) =
        second_camera(&arguments.second_camera, arguments.second_topic)?.unzip();
    // What is to be sorted is kept.
    let is_kept = arguments.truth.truth.is_some() || params.odometry_delay != 0.0;
    let overview = if is_kept {
        let (records, read) = read_all(log);
        whole(arguments.truth.put_into(records)?, read)
    } else {
        read_overview(open, 0)?
    };
    let LogOverview { records: known, n_records, n_images, read } = overview;
    let in_time = without_odometry_delay(&known, params.odometry_delay);
    let records = || -> Result<Box<dyn Iterator<Item = Cow<'_, Record>> + '_>> {
        Ok(if is_kept {
            Box::new(in_time.iter().map(Cow::Borrowed))
        } else {
            Box::new(open()?.map(Cow::Owned))
        })
    };

    let mut outputs = Outputs::open("color", &arguments.common)?;
    let mut estimates: Option<ColorEstimateRecorder> = outputs.estimates(origin)?;
    let stopwatch = Stopwatch::start();
    let mut particles = ParticleSnapshots::new(n_images);
    let bar = terminal::bar(n_records, "colour localization");
    let start = arguments.start.map(|start| start.0);
    let color = color::run_streamed(
        &known,
        records()?,
        second_camera,
        ColorRunSetup { map, bank, params: params.clone(), start, seed: arguments.common.seed },
        |RunStep { system, record, stop, .. }| {
            if let Some(estimates) = &mut estimates {
                estimates.observe(record, system);
            }
            particles.observe(system);
            stop.set(interrupt::is_requested());
            bar.inc(1);
        },
    );
    bar.finish_and_clear();
    let mut color = color?;
    let mut warnings = add_read_problems(color.system.events(), &read);
    if let Some(read) = &second_read {
        warnings.extend(
            add_read_report(color.system.events(), read).map(|text| format!("second camera: {text}")),
        );
    }

    if arguments.priors.is_none() && color.system.events().get("tracking") == 0 {
        color.system.events().warn("priors_doubtful", NEVER_TRACKED);
    }

    let name = name_of(&arguments.log);
    let seconds = stopwatch.elapsed().as_secs_f64();
    let run = ReportRun { name, seconds, warnings, ..color::summarize(&mut color) };
    if let Some(estimates) = estimates {
        estimates.finish()?;
    }
    outputs.show(run, || plots(&mut color, n_images, records()?, &particles))?;
    Ok(ExitCode::SUCCESS)
}

/// Opens the log of a second camera; prints its read problems and assumptions.
fn second_camera(log: &[PathBuf], topics: Vec<String>) -> Result<Option<(RecordIterator, ReadReport)>> {
    if log.is_empty() {
        return Ok(None);
    }
    let options = LogOpenOptions { topics, ..LogOpenOptions::default() };
    let open = || wayfix_sensor_log::open_all(log, &options);
    let overview = read_overview(open, 0).context("cannot read the log of the second camera")?;
    Ok(Some((Box::new(open()?), overview.read)))
}

const NEVER_TRACKED: &str = "no place was tracked, and the priors of the colours are those of simulated halls: `wayfix learn-priors` learns your own, \
`--priors broad` allows any lamp";

/// Frames of the film strip.
const FILM_FRAMES: usize = 5;

fn plots<'a>(
    color: &mut ColorRun,
    n_images: usize,
    records: impl Iterator<Item = Cow<'a, Record>>,
    particles: &ParticleSnapshots,
) -> Result<Vec<SvgPlot>> {
    let mut plots = color::plots(color)?;
    plots.extend(particles.draw(color)?);
    plots.push(color::film(color, n_images, records, FILM_FRAMES)?);
    Ok(plots)
}
