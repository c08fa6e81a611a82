use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
    str::FromStr,
};

use anyhow::{Context, Result, bail, ensure};
use wayfix_appearance_cml::{
    ArchiveParams, Donut, Forgetting, Learning, MapArchive, RingOrder, Start, TurnSense,
};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Format, OpenOptions, ReadReport};

use super::{
    finish::{self, ESTIMATES},
    input::read_toml,
    output::{print, tell},
    progress,
};
use crate::{
    cml::{
        self, CameraChoice, CmlEstimateLog, CmlParams, CmlSystem, MapSaver, PanoramaMap, Plan, StartPlace,
        Task, ViewReader, recording::Recording,
    },
    report::Run,
    system::{Stopwatch, System},
};

/// Appearance maps: learn what places look like all round, and localize in what was learned.
///
/// Views are panoramas (a column for each direction, a row for each height), or raw images of an omnidirectional camera with `--center` and
/// `--radii`. What happens with them, the first line of the output says again:
///
/// * **Concurrent map building and localization**: a log without more options. The map grows from nothing while the robot localizes in it; the
///   start is known.
///
/// * **Learn, then localize**: a folder of frames with poses, or `--withhold N`: every N-th view is localized and never taught, the others are
///   taught with their poses before. With `--learn-from`, another traverse is taught and all views of this one are localized.
///
/// * **Localize in a saved map**: `--map`.
///
/// Poses come as a table, with comma, tab or blanks between the columns. A first row may name them: file or frame, t or time, x, y, heading or theta
/// or yaw, with units as in t_ms, x_cm, yaw_deg (else s, m, rad). Without names: `x,y` or `x,y,heading`, a row a frame, with the file's name or a
/// time before them where there is one. Where poses are by time, the table of `time, file` beside the frames says when each was taken (or `--stamps`),
/// and poses are interpolated. The routes of the University of Sussex (`…_path_scaled.csv`: ms and cm) are read as they are.
///
/// Frames have no wheels: odometry is made of the smoothed path, with noise drawn by `--seed`; its standard deviations are parameters.
///
/// Figures: error_mean_m, error_median_m, error_max_m over the localized views, against nearest_view_error_mean_m of the most alike reference alone and
/// odometry_error_mean_m; n_references; step_mean_us. Views that cannot be used are left out, counted in the events and named on standard error.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES, group(clap::ArgGroup::new("input").required(true).multiple(true).args(["log", "frames", "print_params"])))]
pub(super) struct Arguments {
    /// A log with images, odometry (increments or velocities) and, where it is to be judged, true poses.
    #[arg(long, value_name = "PATH", conflicts_with = "frames")]
    log: Option<PathBuf>,
    /// A folder of PNG or JPEG frames.
    #[arg(long, value_name = "DIR", requires = "poses")]
    frames: Option<PathBuf>,
    /// The table of the poses of the frames.
    #[arg(long, value_name = "CSV", requires = "frames")]
    poses: Option<PathBuf>,
    /// The table of `time, file` of the frames [default: the one beside them].
    #[arg(long, value_name = "FILE", requires = "frames")]
    stamps: Option<PathBuf>,
    /// A folder of frames of another traverse, which is taught in place of this one.
    #[arg(
        long,
        value_name = "DIR",
        requires = "frames",
        requires = "learn_poses",
        conflicts_with = "withhold"
    )]
    learn_from: Option<PathBuf>,
    /// The table of its poses.
    #[arg(long, value_name = "CSV", requires = "learn_from")]
    learn_poses: Option<PathBuf>,
    /// The table of its times.
    #[arg(long, value_name = "FILE", requires = "learn_from")]
    learn_stamps: Option<PathBuf>,
    /// Teach the views with their true poses, but for every N-th, which is localized; 0 teaches none and builds the map as the robot goes
    /// [default: 5 for frames, 0 for a log].
    #[arg(long, value_name = "N")]
    withhold: Option<usize>,
    /// Start with a map that was saved.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["withhold", "learn_from"])]
    map: Option<PathBuf>,
    /// Save the map, and where the robot is in it, at the end: whole or not at all.
    #[arg(long, value_name = "FILE")]
    save_map: Option<PathBuf>,
    /// Save it every so many seconds of the log as well.
    #[arg(long, value_name = "SECONDS", requires = "save_map", value_parser = seconds)]
    save_every: Option<f64>,
    /// Where the robot is at the first view: `anywhere`, `saved` (as the map has it), or x,y,heading in metres and degrees [default: near the first
    /// true pose, else anywhere; for a new map the first true pose, else 0,0,0].
    #[arg(long, value_name = "WHERE", allow_hyphen_values = true)]
    start: Option<StartArgument>,
    /// What is forgotten: `active` also what is not seen where it should be, `passive` what is not seen any more, `none` keeps a learned map as it is
    /// [default: as the parameters say].
    #[arg(long, value_enum)]
    forgetting: Option<ForgettingArgument>,
    /// Raw images: centre of their ring, pixels right and down.
    #[arg(long, value_name = "X,Y", requires = "radii", value_parser = pair)]
    center: Option<[f64; 2]>,
    /// Raw images: inner and outer radius of their ring, pixels.
    #[arg(long, value_name = "INNER,OUTER", requires = "center", value_parser = pair)]
    radii: Option<[f64; 2]>,
    /// Raw images: the innermost ring shows what is highest, as with a lens that looks up; not the outermost.
    #[arg(long, requires = "center")]
    inner_up: bool,
    /// Which way the columns of a panorama go round [default: found from the turns of the robot].
    #[arg(long, value_enum)]
    columns: Option<ColumnsArgument>,
    /// A TOML file of parameters; what it does not name keeps its default. `--print-params` shows all of them.
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Print the parameters that would be used, as TOML, and end: a file to start from.
    #[arg(long)]
    print_params: bool,
    /// Folder for index.html, report.json, the figures as SVG and the estimates as MCAP.
    ///
    /// It is created where need be. Nothing is written without it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the figures as one JSON object instead of a table.
    #[arg(long)]
    json: bool,
    /// Seed of the noise of made odometry, and of the error of the start.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

const EXAMPLES: &str = "\
Examples:
  wayfix run cml --log store.mcap                                            build a map and localize in it
  wayfix run cml --log monday.mcap --save-map store.map                      and keep it
  wayfix run cml --log tuesday.mcap --map store.map --start anywhere
  wayfix run cml --frames route --poses route/training_path_scaled.csv       every fifth frame withheld
  wayfix run cml --frames tuesday --poses tuesday.csv --learn-from monday --learn-poses monday.csv --forgetting none
  wayfix run cml --frames raw --poses raw.csv --center 320,240 --radii 60,230";

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum ForgettingArgument {
    Active,
    Passive,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum ColumnsArgument {
    Clockwise,
    Counterclockwise,
}

#[derive(Clone, Copy, Debug)]
enum StartArgument {
    Anywhere,
    Saved,
    At(Pose2<f64>),
}

impl FromStr for StartArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
        match (text, &numbers[..]) {
            ("anywhere", _) => Ok(Self::Anywhere),
            ("saved", _) => Ok(Self::Saved),
            (_, [x, y, heading]) if numbers.iter().all(|number| number.is_finite()) => {
                Ok(Self::At(Pose2::new(*x, *y, heading.to_radians())))
            }
            _ => Err(
                "give `anywhere`, `saved`, or x,y,heading in metres and degrees, for instance -1.5,0.3,90"
                    .to_owned(),
            ),
        }
    }
}

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let mut params = match &arguments.params {
        Some(path) => read_toml(path, |text| toml::from_str(text))?,
        None => CmlParams::default(),
    };
    arguments.set_forgetting(&mut params);
    if arguments.print_params {
        print(toml::to_string(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let saved = arguments.map.as_deref().map(cml::read_map).transpose()?;
    let stopwatch = Stopwatch::start();
    let Input { mut plan, read, origin } = arguments.input(&mut params, saved.as_ref())?;
    let task = arguments.task();
    let reader = ViewReader::new(params.views, arguments.donut());
    let (system, start) = arguments.begin(task, &params, reader, saved, &mut plan)?;

    let mut estimates = arguments.out.as_deref().map(|out| open_estimates(out, origin)).transpose()?;
    let mut saver = arguments.save_map.clone().map(|path| MapSaver::new(path, arguments.save_every));
    let bar = progress::bar(plan.records.len(), "appearance map");
    let mut remaining = plan.records.iter();
    let run = cml::run(system, &plan, task, start, &params, arguments.seed, |system| {
        if let Some(record) = remaining.next() {
            estimates.iter_mut().for_each(|estimates| estimates.observe(record, system));
            saver.iter_mut().for_each(|saver| saver.observe(record, system));
        }
        bar.inc(1);
    });
    bar.finish_and_clear();
    let mut run = run?;
    finish::account(run.system.events(), &read);
    if let Some(saver) = saver {
        saver.finish(&run.system).context("cannot save the map")?;
    }

    let seconds = stopwatch.elapsed().as_secs_f64();
    let mut summary = Run { name: arguments.name(), seconds, ..cml::summarize(&mut run) };
    tell(summary.notes.join("\n"));
    if let Some(estimates) = estimates {
        estimates.finish()?;
        summary.log = Some(ESTIMATES.to_owned());
        summary.figures = cml::pictures(&run)?;
    }
    finish::show("cml", summary, arguments.out.as_deref(), arguments.json, arguments.seed)?;
    Ok(ExitCode::SUCCESS)
}

/// What is to be done, and how reading it went.
struct Input {
    plan: Plan,
    read: ReadReport,
    origin: Format,
}

/// Frames of a folder of which every so many is withheld.
const WITHHOLD: usize = 5;

impl Arguments {
    fn name(&self) -> String {
        let input = self.log.as_deref().or(self.frames.as_deref());
        input.map_or_else(String::new, |path| path.display().to_string())
    }

    fn withhold(&self) -> usize {
        let default = if self.frames.is_some() && self.map.is_none() { WITHHOLD } else { 0 };
        self.withhold.unwrap_or(default)
    }

    fn task(&self) -> Task {
        match (&self.map, &self.learn_from, self.withhold()) {
            (Some(_), ..) => Task::LocalizeInSavedMap,
            (None, None, 0) => Task::ConcurrentMapBuilding,
            _ => Task::LearnThenLocalize,
        }
    }

    fn donut(&self) -> Option<Donut> {
        let up = if self.inner_up { RingOrder::InnermostUp } else { RingOrder::OutermostUp };
        Some(Donut { center: self.center?, radii: self.radii?, sense: TurnSense::Clockwise, up })
    }

    fn set_forgetting(&self, params: &mut CmlParams) {
        match self.forgetting {
            None => {}
            Some(ForgettingArgument::None) => params.localizer.learning = Learning::Static,
            Some(ForgettingArgument::Active) => params.localizer.map.forgetting = Forgetting::Active,
            Some(ForgettingArgument::Passive) => params.localizer.map.forgetting = Forgetting::Passive,
        }
    }

    fn input(&self, params: &mut CmlParams, saved: Option<&MapArchive>) -> Result<Input> {
        ensure!(
            self.withhold() != 1,
            "--withhold 1 localizes every view and teaches none: give 0 to build the map on the way, or 2 and more"
        );
        let is_static = params.localizer.learning == Learning::Static;
        if is_static && self.task() == Task::ConcurrentMapBuilding {
            bail!(
                "--forgetting none keeps the map as it is, and there is none: teach one (--withhold, --learn-from) or give one (--map)"
            );
        }
        // A saved map knows which way its columns go.
        let saved_sense = saved.map(|archive| archive.params().views.sense);
        let told = self.columns.map(|columns| match columns {
            ColumnsArgument::Clockwise => TurnSense::Clockwise,
            ColumnsArgument::Counterclockwise => TurnSense::Counterclockwise,
        });
        let camera = CameraChoice { donut: self.donut(), sense: told.or(saved_sense) };
        if let Some(log) = &self.log {
            let log = wayfix_sensor_log::open(log, &OpenOptions::default())?;
            let origin = log.meta().first_format();
            let (records, read) = log.read_all();
            if !read.is_clean() {
                tell(&read);
            }
            return Ok(Input {
                plan: Plan::of_log(records, self.withhold(), params, &camera)?,
                read,
                origin,
            });
        }
        let (Some(frames), Some(poses)) = (&self.frames, &self.poses) else {
            bail!("neither a log nor frames")
        };
        let recording = read_recording(frames, poses, self.stamps.as_deref())?;
        let taught = match (&self.learn_from, &self.learn_poses) {
            (Some(frames), Some(poses)) => Some(read_recording(frames, poses, self.learn_stamps.as_deref())?),
            _ => None,
        };
        let plan =
            Plan::of_recording(&recording, taught.as_ref(), self.withhold(), params, &camera, self.seed)?;
        let read = ReadReport::default();
        Ok(Input { plan, read, origin: Format::Images })
    }

    fn begin(
        &self,
        task: Task,
        params: &CmlParams,
        mut reader: ViewReader,
        saved: Option<MapArchive>,
        plan: &mut Plan,
    ) -> Result<(CmlSystem, StartPlace)> {
        let first = cml::first_true_pose(&plan.records);
        let mut state = None;
        let mut map = PanoramaMap::default();
        if let Some(archive) = saved {
            plan.notes.extend(cml::end_note(&archive));
            let size = plan.first_size(&mut reader).unwrap_or(archive.params().size);
            let params = ArchiveParams { views: *reader.params(), size };
            (map, state) = archive.into_map(&params).context("the saved map cannot be used here")?;
        }
        let start = match (self.start, task, first) {
            (Some(StartArgument::Anywhere), ..) => StartPlace::Anywhere,
            (Some(StartArgument::Saved), ..) => {
                let state = state.context("no saved map says where the robot is (--map)")?;
                StartPlace::Saved(Start::Among(state))
            }
            (Some(StartArgument::At(pose)), Task::ConcurrentMapBuilding, _) => StartPlace::Exactly(pose),
            (Some(StartArgument::At(pose)), ..) => StartPlace::Near(pose),
            (None, Task::ConcurrentMapBuilding, first) => {
                StartPlace::Exactly(first.unwrap_or(Pose2::new(0.0, 0.0, 0.0)))
            }
            (None, _, Some(first)) => StartPlace::Near(first),
            (None, _, None) => StartPlace::Anywhere,
        };
        Ok((CmlSystem::new(params, reader, map)?, start))
    }
}

fn read_recording(frames: &Path, poses: &Path, stamps: Option<&Path>) -> Result<Recording> {
    let recording = Recording::read(frames, poses, stamps)?;
    if recording.n_without_pose > 0 {
        tell(format!(
            "note: {} frames of {} have no pose and are left out",
            recording.n_without_pose,
            frames.display()
        ));
    }
    Ok(recording)
}

fn open_estimates(out: &Path, origin: Format) -> Result<CmlEstimateLog> {
    fs::create_dir_all(out).with_context(|| format!("cannot create {}", out.display()))?;
    Ok(CmlEstimateLog::create(&out.join(ESTIMATES), origin)?)
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
