use std::{
    path::{Path, PathBuf},
    str::FromStr,
};

use wayfix_appearance_cml::{AzimuthDirection, OmnidirectionalRing, RingVerticalOrientation};
use wayfix_estimation_traits::Pose2;
use wayfix_systems::cml::CmlTask;
use wayfix_table_log::PoseTableColumns;

use crate::cli::{
    common::Common,
    input::{Topics, name_of},
};

/// Appearance maps: learn places by panoramic images, and localize in the map.
///
/// Views are panoramas (a column for each direction, a row for each height), or raw images of an omnidirectional camera with `--center` and
/// `--radii`. The options determine the task, which the first line of the output states:
///
/// * **Concurrent map building and localization**: a log without more options. The map starts empty and grows while the robot localizes in it; the
///   start is known.
///
/// * **Learn, then localize**: a folder of frames with poses, or `--withhold N`: every N-th view is localized and never learned; the others are
///   learned before, with their poses. With `--learn-from`, another traverse is learned and all views of this one are localized.
///
/// * **Localize in a saved map**: `--map`, or `--resume` to continue from the last pose.
///
/// Poses come as a table, with comma, semicolon, tab or blanks between the columns. Its first row names them: file or frame, t or time, x, y,
/// heading or theta or yaw, with units as in t_ms, x_cm, yaw_deg (else s, m, rad). `--columns` names those of a table without such a row. Poses are
/// matched with frames by file, else by time, else row by row. For a match by time, a table of `time, file` beside the frames (or `--stamps`) gives
/// the frame times. Poses are interpolated over at most 0.5 s, or 1.5 periods of a slower table. Other frames have no pose.
///
/// Frames have no odometry: it is computed from the smoothed path, with noise drawn by `--seed`; its standard deviations are parameters.
///
/// Figures: error_mean_m, error_median_m, error_max_m over the localized views, with nearest_reference_error_mean_m of the most similar reference alone
/// and dead_reckoning_error_mean_m; n_references; step_mean_us. Unusable views are skipped, counted in the events and listed on standard error.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES, group(clap::ArgGroup::new("input").required(true).multiple(true).args(["log", "frames", "print_params"])))]
pub(crate) struct Arguments {
    /// A log with images, odometry (increments or velocities) and, for the errors, true poses. Repeat it for the files of one recording.
    #[arg(long, value_name = "PATH", conflicts_with = "frames")]
    pub(super) log: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) topics: Topics,
    /// A folder of PNG or JPEG frames.
    #[arg(long, value_name = "DIR", requires = "poses")]
    pub(super) frames: Option<PathBuf>,
    /// The table of the poses of the frames.
    #[arg(long, value_name = "CSV", requires = "frames")]
    pub(super) poses: Option<PathBuf>,
    /// Names of the columns of a table of poses that has none, as in t_ms,x_cm,y_cm.
    #[arg(long, value_name = "NAMES", requires = "frames")]
    pub(super) columns: Option<PoseTableColumns>,
    /// Names of the columns of a table of times that has none, as in t_s,file.
    #[arg(long, value_name = "NAMES", requires = "frames")]
    pub(super) stamp_columns: Option<PoseTableColumns>,
    /// The table of `time, file` of the frames [default: the one beside them].
    #[arg(long, value_name = "FILE", requires = "frames")]
    pub(super) stamps: Option<PathBuf>,
    /// A folder of frames of another traverse, which is learned instead of this one.
    #[arg(
        long,
        value_name = "DIR",
        requires = "frames",
        requires = "learn_poses",
        conflicts_with = "withhold"
    )]
    pub(super) learn_from: Option<PathBuf>,
    /// The table of the poses of --learn-from.
    #[arg(long, value_name = "CSV", requires = "learn_from")]
    pub(super) learn_poses: Option<PathBuf>,
    /// The table of the frame times of --learn-from.
    #[arg(long, value_name = "FILE", requires = "learn_from")]
    pub(super) learn_stamps: Option<PathBuf>,
    /// Learn the views with their true poses, except every N-th, which is localized; 0 learns none and builds the map during the run
    /// [default: 5 for frames, 0 for a log].
    #[arg(long, value_name = "N")]
    pub(super) withhold: Option<usize>,
    /// A saved map: a file of `--map-out` or `--save`.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["withhold", "learn_from"])]
    pub(super) map: Option<PathBuf>,
    /// File to save the map to, at the end.
    #[arg(long, value_name = "FILE")]
    pub(super) map_out: Option<PathBuf>,
    /// File to save map and belief to, at the end and every `--save-every` seconds.
    ///
    /// A power failure leaves a whole map.
    #[arg(long, value_name = "FILE")]
    pub(super) save: Option<PathBuf>,
    /// Seconds of the log's time between two saves.
    #[arg(long, value_name = "SECONDS", requires = "save", value_parser = seconds)]
    pub(super) save_every: Option<f64>,
    /// Continue from a file of `--save`, with its map and belief.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["map", "start", "withhold", "learn_from"])]
    pub(super) resume: Option<PathBuf>,
    /// Where the robot is at the first view: `anywhere`, or x,y,heading in metres and degrees [default: near the first true pose, else
    /// anywhere; for a new map the first true pose, else 0,0,0].
    #[arg(long, value_name = "WHERE", allow_hyphen_values = true)]
    pub(super) start: Option<StartArgument>,
    /// Forgetting: `active` also removes references not seen where expected, `passive` removes references no longer seen, `none`
    /// keeps a learned map unchanged [default: from the parameters].
    #[arg(long, value_enum)]
    pub(super) forgetting: Option<ForgettingArgument>,
    /// The localizer as published by Gross et al., without the additions; the odometry noise stays.
    #[arg(long)]
    pub(super) as_published: bool,
    /// Raw images: centre of their ring, pixels right and down.
    #[arg(long, value_name = "X,Y", requires = "radii", value_parser = pair)]
    pub(super) center: Option<[f64; 2]>,
    /// Raw images: inner and outer radius of their ring, pixels.
    #[arg(long, value_name = "INNER,OUTER", requires = "center", value_parser = pair)]
    pub(super) radii: Option<[f64; 2]>,
    /// Raw images: the inner radius shows the highest elevation, as with an upward-looking lens; default: the outer radius.
    #[arg(long, requires = "center")]
    pub(super) inner_up: bool,
    /// Turning sense of the panorama columns [default: determined from the turns of the robot].
    #[arg(long, value_enum)]
    pub(super) column_order: Option<ColumnsArgument>,
    #[command(flatten)]
    pub(super) common: Common,
}

const EXAMPLES: &str = "\
Examples:
  wayfix run cml --log store.mcap                                            build a map and localize in it
  wayfix run cml --log monday.mcap --save store.map                          and keep it
  wayfix run cml --log tuesday.mcap --map store.map --start anywhere
  wayfix run cml --frames route --poses route.csv --columns t_ms,x_cm,y_cm   every fifth frame withheld
  wayfix run cml --frames tuesday --poses tuesday.csv --learn-from monday --learn-poses monday.csv --forgetting none
  wayfix run cml --frames raw --poses raw.csv --center 320,240 --radii 60,230";

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(super) enum ForgettingArgument {
    Active,
    Passive,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum ColumnsArgument {
    Clockwise,
    Counterclockwise,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum StartArgument {
    Anywhere,
    At(Pose2<f64>),
}

impl FromStr for StartArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
        match (text, &numbers[..]) {
            ("anywhere", _) => Ok(Self::Anywhere),
            (_, [x, y, heading]) if numbers.iter().all(|number| number.is_finite()) => {
                Ok(Self::At(Pose2::new(*x, *y, heading.to_radians())))
            }
            _ => {
                Err("give `anywhere`, or x,y,heading in metres and degrees, for instance -1.5,0.3,90"
                    .to_owned())
            }
        }
    }
}

/// Every N-th frame of a folder is withheld, by default.
const WITHHOLD: usize = 5;

impl Arguments {
    pub(super) fn name(&self) -> String {
        name_of(self.frames.as_ref().map_or(self.log.as_slice(), std::slice::from_ref))
    }

    /// The map that the run starts with.
    pub(super) fn given_map(&self) -> Option<&Path> {
        self.map.as_deref().or(self.resume.as_deref())
    }

    pub(super) fn withhold(&self) -> usize {
        let default = if self.frames.is_some() && self.given_map().is_none() { WITHHOLD } else { 0 };
        self.withhold.unwrap_or(default)
    }

    pub(super) fn task(&self) -> CmlTask {
        match (self.given_map(), &self.learn_from, self.withhold()) {
            (Some(_), ..) => CmlTask::LocalizeInSavedMap,
            (None, None, 0) => CmlTask::ConcurrentMapBuilding,
            _ => CmlTask::LearnThenLocalize,
        }
    }

    pub(super) fn donut(&self) -> Option<OmnidirectionalRing> {
        let up = if self.inner_up {
            RingVerticalOrientation::InnermostUp
        } else {
            RingVerticalOrientation::OutermostUp
        };
        Some(OmnidirectionalRing {
            center: self.center?,
            radii: self.radii?,
            azimuth_direction: AzimuthDirection::Clockwise,
            ring_orientation: up,
        })
    }
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match numbers[..] {
        [a, b] if a.is_finite() && b.is_finite() => Ok([a, b]),
        _ => Err("give two numbers of pixels, for instance 320,240".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds >= 0.0 => Ok(seconds),
        _ => Err("give seconds, 0 or more".to_owned()),
    }
}
