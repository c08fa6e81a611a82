use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    str::FromStr,
};

use anyhow::{Context, Result};
use clap::builder::RangedU64ValueParser;
use wayfix_condensation::{ActionSelection, LightChange, RgbImage, shifted};
use wayfix_evaluation::report::ReportRun;
use wayfix_evaluation::terminal::{self, print, print_message};
use wayfix_system_core::{Stopwatch, settings::from_toml};
use wayfix_systems::views::{
    self, DescriptorKind, LightNormalization, LoggedDrawing, LoggedViews, RealSceneTransform, ViewSystem,
    ViewSystemConfig, ViewsParams, ViewsRun,
};
use wayfix_table_log::{MoveTable, MovedFrameFolder};

use super::super::{common::Common, outputs::Outputs, parameter_file::read_toml};
use super::interrupt;
use crate::commented::commented;

/// State condensation: estimates which view of a scene a robot sees, from global image features.
///
/// An image is divided into overlapping views, one every --step pixels; each is a place. The robot learns the features of every view. It starts at a
/// random place of the same scene on another day (other light, shifted by some pixels). It drives to a goal, one view per move, until it reports that
/// it is there. This is repeated --trials times with random starts and goals.
///
/// Without --learn-from the other day is computed from the image: gain 0.7, offset 20, gamma 1.3, a shift of 4,3 pixels, unless options override
/// them. With --learn-from both images are used as they are, and options apply only if given.
///
/// `successes` counts the drives that report the goal and are there; a drive that ends uncertain is no success. `steps_mean` is the mean number of
/// moves of a drive, `steps_to_certainty_mean` that until the belief first reaches 0.999, the confidence required to stop.
///
/// With --log the robot does not drive: the pictures of a folder are localized among those of --learn-from, one picture a place. `moves.csv` in a folder
/// names for each picture the commanded move (`dx`, `dy`) and the true place (`column`, `row`); without it pictures are one place apart.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// The scene that the robot drives in, JPEG or PNG.
    #[arg(long, value_name = "IMAGE", required_unless_present_any = ["print_params", "log"])]
    scene: Option<PathBuf>,
    /// A logged drive: a folder of pictures, each after a move.
    #[arg(long, value_name = "DIR", requires = "learn_from", conflicts_with_all = SCENE_OPTIONS)]
    log: Option<PathBuf>,
    /// Table of the moves of --log [default: moves.csv in the folder, else each picture is one column on].
    #[arg(long, value_name = "FILE", requires = "log")]
    actions: Option<PathBuf>,
    /// Table of a drive with slip, `dx,dy,column,row`: transitions and diffusion are learned from it.
    #[arg(long, value_name = "FILE")]
    moves: Option<PathBuf>,
    /// The scene as it was learned, of the same size [default: --scene]; with --log the folder of learned pictures.
    #[arg(long, value_name = "PATH")]
    learn_from: Option<PathBuf>,
    /// Width and height of a view, pixels.
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = positive())]
    view: u64,
    /// Pixels between neighbouring views.
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = positive())]
    step: u64,
    /// Feature measured in a view.
    #[arg(long, value_enum, value_name = "NAME", default_value = "mean-var")]
    feature: DescriptorKind,
    /// Normalization of the current light to that of learning.
    #[arg(long, value_enum, value_name = "HOW", default_value = "whole-scene")]
    normalization: LightNormalization,
    /// Drives with random start and goal.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = positive())]
    trials: u64,
    /// Contrast of the real scene [default: 0.7, or 1 with --learn-from].
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true)]
    gain: Option<f64>,
    /// Brightness of the real scene, grey levels [default: 20, or 0 with --learn-from].
    #[arg(long, value_name = "LEVELS", allow_hyphen_values = true)]
    offset: Option<f64>,
    /// Bend of the real scene's tone curve [default: 1.3, or 1 with --learn-from].
    #[arg(long, value_name = "EXPONENT", allow_hyphen_values = true)]
    gamma: Option<f64>,
    /// Shift of the real camera to the right and down, pixels [default: 4,3, or 0,0 with --learn-from].
    #[arg(long, value_name = "DX,DY", allow_hyphen_values = true)]
    shift: Option<Shift>,
    /// Estimate the mean shift of the camera of --scene relative to that of --learn-from, up to N pixels in each direction, and remove it.
    #[arg(long, value_name = "N", value_parser = positive(), requires = "learn_from")]
    register: Option<u64>,
    /// Among moves that end equally near to the goal, take the one with the largest expected information, comparing the N best places.
    #[arg(long, value_name = "N")]
    informed: Option<usize>,
    /// The method as published by Kasprzak & Szynkiewicz, without the additions; the paper has no normalization `online`.
    #[arg(long, conflicts_with = "params")]
    as_published: bool,
    #[command(flatten)]
    common: Common,
}

/// Options that a logged drive does not use.
const SCENE_OPTIONS: [&str; 11] = [
    "scene",
    "view",
    "step",
    "normalization",
    "trials",
    "gain",
    "offset",
    "gamma",
    "shift",
    "register",
    "informed",
];

const EXAMPLES: &str = "\
Examples:
  wayfix run views --scene china.jpg --out results
  wayfix run views --scene china.jpg --view 256 --step 16 --feature hist6 --normalization online
  wayfix run views --scene right.png --learn-from left.png --register 64 --feature joined
  wayfix run views --log tuesday --learn-from monday --moves drive.csv --feature joined
  wayfix run views --scene china.jpg --gain 1 --offset -30 --gamma 1 --shift -5,0 --json";

fn positive() -> RangedU64ValueParser {
    RangedU64ValueParser::new().range(1..=1_000_000)
}

#[derive(Clone, Copy, Debug)]
struct Shift((i32, i32));

impl FromStr for Shift {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<Option<i32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers[..] {
            [Some(dx), Some(dy)] => Ok(Self((dx, dy))),
            _ => Err("give two whole numbers of pixels, right and down, for instance 4,-3".to_owned()),
        }
    }
}

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let mut params = match &arguments.common.params {
        Some(path) => read_toml(path, "views", from_toml::<ViewsParams>)?,
        None if arguments.as_published => ViewsParams::as_published(),
        None => ViewsParams::default(),
    };
    if let Some(hypotheses) = arguments.informed {
        params.navigator.action_selection = ActionSelection::Informed { hypotheses };
    }
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let moves = arguments.moves.as_deref().map(MoveTable::read).transpose()?;
    if let Some(moves) = moves.as_ref().filter(|moves| !moves.read.is_clean()) {
        print_message(&moves.read);
    }
    if let Some(log) = &arguments.log {
        return logged(&arguments, log, moves.as_ref(), &params);
    }
    let scene_path = arguments.scene.as_deref().context("give --scene")?;
    let scene = read(scene_path)?;
    let learned = arguments.learn_from.as_deref().map(read).transpose()?;
    let mut real = arguments.real_scene().of(&scene)?;
    let learned = learned.as_ref().unwrap_or(&scene);
    if let Some(reach) = arguments.register {
        let (dx, dy) = views::mean_shift(learned, &real, reach as usize);
        print_message(format!(
            "note: the real camera stood {dx} pixels to the right and {dy} down of the learned one"
        ));
        real = shifted(&real, -dx, -dy);
    }

    let mut outputs = Outputs::open("views", &arguments.common)?;
    let stopwatch = Stopwatch::start();
    let setup = ViewSystemConfig {
        view: arguments.view as usize,
        step: arguments.step as usize,
        feature: arguments.feature,
        normalization: arguments.normalization,
    };
    let mut system = ViewSystem::learn(learned, &real, &setup, &params)?;
    if let Some(moves) = &moves {
        system = system.with_moves(moves)?;
    }
    let bar = terminal::bar(arguments.trials as usize, "drives");
    let (learning, seed) = (stopwatch.elapsed(), arguments.common.seed);
    let run = ViewsRun::drive(system, learning, arguments.trials, seed, &|| {
        bar.inc(1);
        interrupt::flow()
    });
    bar.finish_and_clear();
    let views = run?;

    let name = scene_path.display().to_string();
    let seconds = stopwatch.elapsed().as_secs_f64();
    let warnings = interrupt::warning().into_iter().collect();
    let run = ReportRun { name, seconds, warnings, ..views::summarize(&views) };
    let sinks = outputs.sinks()?;
    if !sinks.is_empty() {
        views::draw_drive(&views, &real, arguments.common.seed, outputs.has_echo(), sinks)?;
    }
    outputs.show(run, || views::plots(&views, learned, &real, arguments.common.seed))?;
    Ok(ExitCode::SUCCESS)
}

/// Localizes the pictures of a folder.
fn logged(
    arguments: &Arguments,
    log: &Path,
    moves: Option<&MoveTable>,
    params: &ViewsParams,
) -> Result<ExitCode> {
    let folder = |path: &Path, table: Option<&Path>| -> Result<MovedFrameFolder> {
        let folder = MovedFrameFolder::read(path, table)?;
        if !folder.read.is_clean() {
            print_message(&folder.read);
        }
        if !folder.has_table {
            print_message(format!("note: {} has no table: each picture is one place on", path.display()));
        }
        Ok(folder)
    };
    let learn_from = arguments.learn_from.as_deref().context("give --learn-from")?;
    let learned = folder(learn_from, None)?;
    let drive = folder(log, arguments.actions.as_deref())?;
    let mut outputs = Outputs::open("views", &arguments.common)?;
    let (sinks, n_frames) = (outputs.sinks()?, drive.frames.len());
    let mut drawing = (!sinks.is_empty()).then(|| LoggedDrawing::new(n_frames, outputs.has_echo(), sinks));
    let mut drawn = Ok(());
    let stopwatch = Stopwatch::start();
    let bar = terminal::bar(n_frames, "frames");
    let run =
        LoggedViews::localize(&learned, &drive, moves, arguments.feature, params, |grid, view, image| {
            if let Some(drawing) = drawing.as_mut().filter(|_| drawn.is_ok()) {
                drawn = drawing.draw(grid, view, image);
            }
            bar.inc(1);
            interrupt::flow()
        });
    bar.finish_and_clear();
    let run = run?;
    let (name, seconds) = (log.display().to_string(), stopwatch.elapsed().as_secs_f64());
    let warnings = interrupt::warning().into_iter().collect();
    let summary = ReportRun { name, seconds, warnings, ..run.summarize() };
    drawn?;
    drawing.map_or(Ok(()), LoggedDrawing::finish)?;
    outputs.show(summary, || views::logged_plots(&run, arguments.feature))?;
    Ok(ExitCode::SUCCESS)
}

impl Arguments {
    fn real_scene(&self) -> RealSceneTransform {
        let default = if self.learn_from.is_some() {
            RealSceneTransform::UNCHANGED
        } else {
            RealSceneTransform::default()
        };
        let light = LightChange {
            gain: self.gain.unwrap_or(default.light.gain),
            offset: self.offset.unwrap_or(default.light.offset),
            gamma: self.gamma.unwrap_or(default.light.gamma),
        };
        RealSceneTransform { light, shift: self.shift.map_or(default.shift, |shift| shift.0) }
    }
}

/// Reads an image and prints conversions that changed it.
fn read(path: &Path) -> Result<RgbImage> {
    let scene = views::read_scene(path)?;
    for remark in scene.remarks {
        print_message(format!("note: {} {remark}", path.display()));
    }
    Ok(scene.picture)
}
