use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::Deserialize;
use wayfix_evaluation::report::ReportRun;
use wayfix_scene_sim::film::{OcclusionEvent, SyntheticFilm};
use wayfix_sensor_log::{LogFormat, LogOpenOptions};
use wayfix_system_core::RunStep;
use wayfix_systems::track::{
    self, TrackEstimateRecorder, TrackParams, TrackSystem, TrackerConfig, TrackingMethod, TrueBoxes,
};
use wayfix_visual_tracking::{ColorSpace, HeadDetector};

use crate::films;

use super::super::PlannedJob;

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// A simulated film, instead of `data`.
    film: Option<String>,
    /// Event that affects the target.
    occlusion: Option<String>,
    /// Number of seeds.
    #[serde(default = "twenty")]
    n_seeds: u64,
    /// The same with `--quick`, and the number of frames.
    #[serde(default = "two")]
    n_seeds_quick: u64,
    #[serde(default = "fifty")]
    n_frames_quick: usize,
    /// The trackers.
    methods: Vec<TrackingMethod>,
    /// The method as published, without the additions.
    #[serde(default)]
    as_published: bool,
    /// Whether the contour tracker learns its colour dynamics from a training film.
    #[serde(default)]
    learns_dynamics: bool,
    /// Whether a stereo camera measures the distance of the head.
    #[serde(default)]
    has_stereo: bool,
    /// Space of the contour tracker's colours, unless it is the default.
    color_space: Option<ColorSpace>,
    /// Largest rate, in degrees a second, of a pan/tilt head that turns a part of the film's view after the target.
    pan_tilt_rate_deg_s: Option<f64>,
    /// Numbers of the frames, from and up to, that teach a head, which is then detected in the first frames instead of given.
    detect_from: Option<[usize; 2]>,
    /// Whether the recording is run from other starts too, see [`films::starts`].
    #[serde(default)]
    other_starts: bool,
    /// True boxes: of a recording relative to the folder given by `--data`, of a stored log beside the plan.
    truth: Option<PathBuf>,
}

fn twenty() -> u64 {
    20
}

fn two() -> u64 {
    2
}

fn fifty() -> usize {
    50
}

impl Settings {
    fn params(&self) -> TrackParams {
        let mut params = if self.as_published { TrackParams::as_published() } else { TrackParams::default() };
        params.contour.color_space = self.color_space.unwrap_or(params.contour.color_space);
        params
    }
}

/// A film or a recording through its trackers.
pub(super) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let settings: Settings = job.planned.settings()?;
    match &settings.film {
        Some(name) => film(job, &settings, name),
        None => recording(job, &settings),
    }
}

fn film(job: &PlannedJob<'_>, settings: &Settings, name: &str) -> Result<ReportRun> {
    let occlusion = settings.occlusion.as_deref().map(OcclusionEvent::named).transpose()?.unwrap_or_default();
    let mut film = SyntheticFilm { occlusion, ..SyntheticFilm::named(name)? };
    let mut n_seeds = settings.n_seeds;
    if job.options.quick {
        (film.n_frames, n_seeds) = (settings.n_frames_quick, settings.n_seeds_quick);
    }
    let first = 1000 * job.options.seed;
    if let Some(rate) = settings.pan_tilt_rate_deg_s {
        return films::active(&film, first..first + n_seeds, rate.to_radians());
    }
    if settings.has_stereo {
        return films::stereo(&film, first..first + n_seeds, &settings.params().head);
    }
    if settings.learns_dynamics {
        return films::learned(&film, first..first + n_seeds, &settings.params().contour);
    }
    films::table(&film, first..first + n_seeds, &settings.methods, &settings.params())
}

fn recording(job: &PlannedJob<'_>, settings: &Settings) -> Result<ReportRun> {
    let is_stored = job.planned.log.is_some();
    let format = if is_stored { LogFormat::Mcap } else { LogFormat::Images };
    let options = LogOpenOptions { format: Some(format), ..LogOpenOptions::default() };
    let mut log = wayfix_sensor_log::open(job.log()?, &options)?;
    let truth = settings.truth.as_ref().context("a recording needs `truth`")?;
    let truth = TrueBoxes::read(&if is_stored { job.beside_plan(truth) } else { job.recording(truth)? })?;
    let method = *settings.methods.first().context("give `methods`")?;
    let rate_hz = (!is_stored).then_some(options.frame_rate_hz);
    let params = settings.params();
    if settings.other_starts {
        return films::starts(&mut log, &truth, method, &params);
    }
    let learn = |[first, end]: [usize; 2]| -> Result<HeadDetector> {
        let mut log = wayfix_sensor_log::open(job.log()?, &options)?;
        Ok(track::learn_head(&mut log, &truth, rate_hz, first..end, &params.head, job.log()?)?)
    };
    let detector = settings.detect_from.map(learn).transpose()?;
    let setup = TrackerConfig { method, truth, rate_hz, params, detector, ..TrackerConfig::default() };
    let system = TrackSystem::new(setup, job.options.seed);
    let (name, path) = job.estimates_file();
    let mut estimates =
        TrackEstimateRecorder::create(&path, &path.with_extension("txt"), log.meta().first_format())?;
    let mut run =
        track::run(system, &mut log, |RunStep { system, record, .. }| estimates.observe(record, system))?;
    estimates.finish(run.system.n_frames())?;
    Ok(ReportRun { log: Some(name), figures: track::plots(&run.run_history)?, ..track::summarize(&mut run) })
}
