//! `wayfix run cml`.

mod arguments;

use std::{borrow::Cow, path::Path, process::ExitCode};
use wayfix_evaluation::report::ReportRun;
use wayfix_evaluation::terminal::{self, print, print_message};
use wayfix_system_core::{LogOverview, RunStep, Stopwatch, System, without_odometry_delay};
use wayfix_systems::cml::{
    self, CameraViewGeometry, CmlEstimateRecorder, CmlParams, CmlRunPlan, CmlRunSetup, CmlStartPose,
    CmlSystem, CmlTask, PanoramaMap, PeriodicMapSaver, ViewDescriptorReader,
};
use wayfix_table_log::{PoseTables, PosedFrameFolder};

use anyhow::{Context, Result, bail, ensure};
use wayfix_appearance_cml::{
    ArchivedDescriptorFormat, AzimuthDirection, ForgettingMode, LocalizerParams, MapArchive, MapLearning,
    StartPosePrior,
};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Log, LogError, LogFormat, LogOpenOptions, ReadReport, Record};

pub(in crate::cli) use arguments::Arguments;
use arguments::{ColumnsArgument, ForgettingArgument, StartArgument};

use super::super::{
    outputs::Outputs,
    parameter_file::read_toml,
    read_problems::{add_read_problems, read_all, read_overview, whole},
};
use super::interrupt;
use crate::commented::commented;

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let mut params = match &arguments.common.params {
        Some(path) => read_toml(path, "cml", |text| toml::from_str(text))?,
        None => CmlParams::default(),
    };
    arguments.set_published(&mut params);
    arguments.set_forgetting(&mut params);
    if arguments.common.print_params {
        print(commented(&params)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let saved = arguments.given_map().map(cml::read_map).transpose()?;
    let stopwatch = Stopwatch::start();
    let Input { mut plan, read, origin, n_records, is_kept } =
        arguments.input(&mut params, saved.as_ref())?;
    let task = arguments.task();
    let reader = ViewDescriptorReader::new(params.panorama_descriptor, arguments.donut());
    let (system, start) = arguments.begin(task, &params, reader, saved, &mut plan)?;

    let mut outputs = Outputs::open("cml", &arguments.common)?;
    let mut estimates: Option<CmlEstimateRecorder> = outputs.estimates(origin)?;
    let mut saver = arguments.save.clone().map(|path| PeriodicMapSaver::new(path, arguments.save_every));
    let bar = terminal::bar(n_records, "appearance map");
    let in_time;
    let records: Box<dyn Iterator<Item = Cow<'_, Record>>> = if is_kept {
        in_time = without_odometry_delay(&plan.records, params.odometry_delay);
        Box::new(in_time.iter().map(Cow::Borrowed))
    } else {
        Box::new(arguments.open()?.map(Cow::Owned))
    };
    let seed = arguments.common.seed;
    let setup = CmlRunSetup { system, plan: &plan, task, start, params: &params, seed };
    let run = cml::run_streamed(setup, records, |RunStep { system, record, stop, .. }| {
        estimates.iter_mut().for_each(|estimates| estimates.observe(record, system));
        saver.iter_mut().for_each(|saver| saver.observe(record, system));
        stop.set(interrupt::is_requested());
        bar.inc(1);
    });
    bar.finish_and_clear();
    let mut run = run?;
    let warnings = add_read_problems(run.system.events(), &read);
    if let Some(saver) = saver {
        saver.finish(&run.system).context("cannot save the map")?;
    }
    if let Some(path) = &arguments.map_out {
        PeriodicMapSaver::new(path.clone(), None).finish(&run.system).context("cannot write the map")?;
    }

    let seconds = stopwatch.elapsed().as_secs_f64();
    let summary = ReportRun { name: arguments.name(), seconds, warnings, ..cml::summarize(&mut run) };
    print_message(summary.notes.join("\n"));
    if let Some(estimates) = estimates {
        estimates.finish()?;
    }
    outputs.show(summary, || Ok(cml::plots(&run)?))?;
    Ok(ExitCode::SUCCESS)
}

/// The task, and the read report.
struct Input {
    plan: CmlRunPlan,
    read: ReadReport,
    origin: LogFormat,
    n_records: usize,
    /// Whether the plan has all records; else they are read again.
    is_kept: bool,
}

impl Arguments {
    /// Sets the localizer as published. Odometry describes the robot, not the method.
    fn set_published(&self, params: &mut CmlParams) {
        if self.as_published {
            let odometry = params.localizer.odometry;
            params.localizer = LocalizerParams { odometry, ..LocalizerParams::as_published() };
        }
    }

    fn set_forgetting(&self, params: &mut CmlParams) {
        match self.forgetting {
            None => {}
            Some(ForgettingArgument::None) => params.localizer.map_learning = MapLearning::Static,
            Some(ForgettingArgument::Active) => params.localizer.map.forgetting_mode = ForgettingMode::Active,
            Some(ForgettingArgument::Passive) => {
                params.localizer.map.forgetting_mode = ForgettingMode::Passive;
            }
        }
    }

    fn input(&self, params: &mut CmlParams, saved: Option<&MapArchive>) -> Result<Input> {
        ensure!(
            self.withhold() != 1,
            "--withhold 1 localizes every view and teaches none: give 0 to build the map on the way, or 2 and more"
        );
        let is_static = params.localizer.map_learning == MapLearning::Static;
        if is_static && self.task() == CmlTask::ConcurrentMapBuilding {
            bail!(
                "--forgetting none keeps the map as it is, and there is none: teach one (--withhold, --learn-from) or give one (--map)"
            );
        }
        // A saved map stores the turning sense of its columns.
        let saved_sense = saved.map(|archive| archive.params().views.azimuth_direction);
        let told = self.column_order.map(|columns| match columns {
            ColumnsArgument::Clockwise => AzimuthDirection::Clockwise,
            ColumnsArgument::Counterclockwise => AzimuthDirection::Counterclockwise,
        });
        let camera = CameraViewGeometry { donut: self.donut(), sense: told.or(saved_sense) };
        if !self.log.is_empty() {
            let log = self.open()?;
            let origin = log.meta().first_format();
            // What is to be sorted or taught is kept.
            let is_kept = self.withhold() > 0 || params.odometry_delay != 0.0;
            let LogOverview { records, n_records, read, .. } = if is_kept {
                let (records, read) = read_all(log);
                whole(records, read)
            } else {
                read_overview(|| self.open(), cml::N_EVIDENCE)?
            };
            let plan = CmlRunPlan::of_log(records, self.withhold(), params, &camera)?;
            return Ok(Input { plan, read, origin, n_records, is_kept });
        }
        let (Some(frames), Some(poses)) = (&self.frames, &self.poses) else {
            bail!("neither a log nor frames")
        };
        let recording = self.recording(frames, poses, self.stamps.as_deref())?;
        let taught = match (&self.learn_from, &self.learn_poses) {
            (Some(frames), Some(poses)) => {
                Some(self.recording(frames, poses, self.learn_stamps.as_deref())?)
            }
            _ => None,
        };
        let plan = CmlRunPlan::of_recording(
            &recording,
            taught.as_ref(),
            self.withhold(),
            params,
            &camera,
            self.common.seed,
        )?;
        let mut read = ReadReport::default();
        for recording in taught.iter().chain([&recording]) {
            read.join(&recording.read);
        }
        let n_records = plan.records.len();
        Ok(Input { plan, read, origin: LogFormat::Images, n_records, is_kept: true })
    }

    fn open(&self) -> Result<Log, LogError> {
        let options = LogOpenOptions { topics: self.topics.topics.clone(), ..LogOpenOptions::default() };
        wayfix_sensor_log::open_all(&self.log, &options)
    }

    fn begin(
        &self,
        task: CmlTask,
        params: &CmlParams,
        mut reader: ViewDescriptorReader,
        saved: Option<MapArchive>,
        plan: &mut CmlRunPlan,
    ) -> Result<(CmlSystem, CmlStartPose)> {
        let first = cml::first_true_pose(&plan.records);
        let mut state = None;
        let mut map = PanoramaMap::default();
        if let Some(archive) = saved {
            plan.notes.extend(cml::end_note(&archive));
            let size = plan.first_size(&mut reader).unwrap_or(archive.params().size);
            let params = ArchivedDescriptorFormat { views: *reader.params(), size };
            (map, state) = archive.into_map(&params).context("the saved map cannot be used here")?;
        }
        let start = match (self.start, task, first) {
            _ if self.resume.is_some() => {
                let state = state.context("the file does not say where the robot was: give it as --map")?;
                CmlStartPose::Saved(StartPosePrior::Among(state))
            }
            (Some(StartArgument::Anywhere), ..) => CmlStartPose::Anywhere,
            (Some(StartArgument::At(pose)), CmlTask::ConcurrentMapBuilding, _) => CmlStartPose::Exactly(pose),
            (Some(StartArgument::At(pose)), ..) => CmlStartPose::Near(pose),
            (None, CmlTask::ConcurrentMapBuilding, first) => {
                CmlStartPose::Exactly(first.unwrap_or(Pose2::new(0.0, 0.0, 0.0)))
            }
            (None, _, Some(first)) => CmlStartPose::Near(first),
            (None, _, None) => CmlStartPose::Anywhere,
        };
        Ok((CmlSystem::new(params, reader, map)?, start))
    }

    fn recording(&self, frames: &Path, poses: &Path, stamps: Option<&Path>) -> Result<PosedFrameFolder> {
        let (columns, stamp_columns) = (self.columns.as_ref(), self.stamp_columns.as_ref());
        let recording =
            PosedFrameFolder::read(frames, &PoseTables { poses, columns, stamps, stamp_columns })?;
        if !recording.read.is_clean() {
            print_message(&recording.read);
        }
        recording.notes.iter().for_each(|note| print_message(format!("note: {note}")));
        Ok(recording)
    }
}
