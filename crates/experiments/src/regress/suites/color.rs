use std::{ops::Range, path::PathBuf, sync::Arc};

use anyhow::Result;
use serde::Deserialize;
use wayfix_color_map::ColorMap;
use wayfix_evaluation::report::ReportRun;
use wayfix_scene_sim::{
    Scenario, ScenarioParams,
    league::{ExposureMode, LampSetting, LeagueParams},
};
use wayfix_sensor_log::{LogOpenOptions, Record};
use wayfix_system_core::{RunStep, System};
use wayfix_systems::color::{
    self, ColorEstimateRecorder, ColorRunSetup, ColorSystemParams, ParticleSnapshots, priors,
};

use crate::color::{self as experiments, TrainingHalls};

use super::super::PlannedJob;

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// The experiment.
    #[serde(default)]
    experiment: Experiment,
    /// The map, relative to the folder of the plan.
    #[serde(default = "field")]
    map: PathBuf,
    /// A file of parameters, relative to the folder of the plan.
    params: Option<PathBuf>,
    /// The method as published, without the additions.
    #[serde(default)]
    as_published: bool,
    /// Number of kinds of light to learn priors for, one Gaussian each; without it the built-in priors, of two, are used.
    lights: Option<usize>,
    /// Seconds of the log that run with `--quick`; all of it if omitted.
    quick_s: Option<f64>,
    /// Number of halls, for experiments over many.
    #[serde(default = "hundred")]
    n_seeds: u64,
    /// The same with `--quick`.
    #[serde(default = "ten")]
    n_seeds_quick: u64,
    /// Names of the labelled images to draw.
    #[serde(default)]
    shown: Vec<String>,
    /// Names of the bags of real places.
    #[serde(default)]
    places: Vec<String>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Experiment {
    /// A log through the localizer.
    #[default]
    Localize,
    /// Each colour withheld in turn, joint prior against independent.
    Withheld,
    /// Jump Markov, IMM, GPB2 and a single filter while lights are switched.
    Switching,
    /// Global localization, in many halls.
    GlobalStart,
    /// Relocalization after a kidnapping, in many halls.
    Kidnapped,
    /// The drive of the log in random halls.
    OtherHallsDark,
    /// The same in bright light.
    OtherHallsBright,
    /// Each colour withheld in turn, in random dark halls.
    WithheldHallsDark,
    /// The same in bright light.
    WithheldHallsBright,
    /// The same with a camera that sets exposure and white balance for every picture, and pale paints.
    WithheldHallsAutomatic,
    /// Frame time against the number of particles.
    FrameTime,
    /// Recorded images of the middle-size league.
    Venues,
    /// Labelled images of a real field.
    LabelledImages,
    /// Localization at places of a real field.
    RealPlaces,
}

/// Paints half as far from grey as those of the league: chosen before any run, as a halving.
const PALE_CHROMA: f64 = 0.5;

fn under(lighting: LampSetting) -> LeagueParams {
    LeagueParams { lamp_settings: vec![(0, lighting)], ..LeagueParams::default() }
}

fn field() -> PathBuf {
    "four-legged-field.toml".into()
}

fn hundred() -> u64 {
    100
}

fn ten() -> u64 {
    10
}

/// An experiment with the localizer.
pub(super) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    let settings: Settings = job.planned.settings()?;
    let mut params: ColorSystemParams = match &settings.params {
        Some(file) => toml::from_str(&job.read(file)?)?,
        None => ColorSystemParams::default(),
    };
    if settings.as_published {
        params.set_published();
    }
    let map = Arc::new(color::read_map(&job.options.fixtures.join(&settings.map))?);
    let learned =
        settings.lights.map_or_else(priors::built_in, |k| TrainingHalls::default().learn_priors(k))?;
    let seed = job.options.seed;
    let bank = priors::bank(&learned, &params)?;
    let seeds = settings.seeds(job);
    match settings.experiment {
        Experiment::Localize => localize(job, settings.quick_s, map, &params),
        Experiment::Withheld => {
            experiments::withheld(&records(job, settings.quick_s)?, &map, &learned, &params, seed)
        }
        Experiment::Switching => {
            let single = priors::bank(&TrainingHalls::default().learn_priors(1)?, &params)?;
            experiments::switching(
                &records(job, settings.quick_s)?,
                &switches(job),
                &map,
                &bank,
                &single,
                &params,
                seed,
            )
        }
        Experiment::GlobalStart => Ok(experiments::global_start(seeds, &map, &bank, &params)?.report()?),
        Experiment::Kidnapped => Ok(experiments::kidnapped(seeds, &map, &bank, &params)?.report()?),
        Experiment::OtherHallsDark => {
            experiments::other_halls(seeds, &under(LampSetting::Dark), &map, &bank, &params)
        }
        Experiment::OtherHallsBright => {
            experiments::other_halls(seeds, &under(LampSetting::Bright), &map, &bank, &params)
        }
        Experiment::WithheldHallsDark => {
            experiments::withheld_in_halls(seeds, &under(LampSetting::Dark), &map, &learned, &params)
        }
        Experiment::WithheldHallsBright => {
            experiments::withheld_in_halls(seeds, &under(LampSetting::Bright), &map, &learned, &params)
        }
        Experiment::WithheldHallsAutomatic => {
            let halls = TrainingHalls {
                exposure_mode: ExposureMode::Automatic,
                paint_chroma: PALE_CHROMA,
                ..TrainingHalls::default()
            };
            let drive = LeagueParams {
                exposure_mode: halls.exposure_mode,
                paint_chroma: halls.paint_chroma,
                ..LeagueParams::default()
            };
            let learned = halls.learn_priors(settings.lights.unwrap_or(2))?;
            experiments::withheld_in_halls(seeds, &drive, &map, &learned, &params)
        }
        Experiment::FrameTime => experiments::frame_time(&records(job, None)?, &map, &bank, &params, seed),
        Experiment::Venues => crate::venues::run(job.log()?),
        Experiment::LabelledImages => crate::labelled::run(job.log()?, &settings.shown, &params),
        Experiment::RealPlaces => experiments::real_places(job.log()?, &settings.places, seeds, &params),
    }
}

impl Settings {
    /// Seeds disjoint from those of the stored logs and of the training venues.
    fn seeds(&self, job: &PlannedJob<'_>) -> Range<u64> {
        const FIRST: u64 = 10_000;
        let n = if job.options.quick { self.n_seeds_quick } else { self.n_seeds };
        let first = FIRST + 1000 * job.options.seed;
        first..first + n
    }
}

fn records(job: &PlannedJob<'_>, quick_s: Option<f64>) -> Result<Vec<Record>> {
    let (records, _) = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?.read_all();
    Ok(first_seconds(records, quick_s.filter(|_| job.options.quick)))
}

/// The records of the first `seconds`, or all.
fn first_seconds(mut records: Vec<Record>, seconds: Option<f64>) -> Vec<Record> {
    if let (Some(seconds), Some(start)) = (seconds, records.first().map(|record| record.stamp)) {
        records.retain(|record| record.stamp.seconds_since(start) <= seconds);
    }
    records
}

/// The frames at which the light of a stored log changes.
fn switches(job: &PlannedJob<'_>) -> Vec<usize> {
    let name = job.planned.log.as_ref().and_then(|log| log.file_stem()).and_then(|stem| stem.to_str());
    match name.and_then(|name| Scenario::named(name).ok()).map(|scenario| scenario.params) {
        Some(ScenarioParams::League(drive)) => {
            drive.lamp_settings.iter().map(|(frame, _)| *frame).filter(|frame| *frame > 0).collect()
        }
        _ => Vec::new(),
    }
}

fn localize(
    job: &PlannedJob<'_>,
    quick_s: Option<f64>,
    map: Arc<ColorMap>,
    params: &ColorSystemParams,
) -> Result<ReportRun> {
    let log = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?;
    let (name, path) = job.estimates_file();
    let mut estimates = ColorEstimateRecorder::create(&path, log.meta().first_format())?;
    let (records, read) = log.read_all();
    let records = first_seconds(records, quick_s.filter(|_| job.options.quick));
    let bank = priors::bank(&priors::built_in()?, params)?;
    let mut particles = ParticleSnapshots::new(color::n_images(&records));
    let setup = ColorRunSetup::new(&map, &bank, params, job.options.seed);
    let mut run = color::run(&records, setup, |RunStep { system, record, .. }| {
        estimates.observe(record, system);
        particles.observe(system);
    })?;
    estimates.finish()?;
    run.system.events().add("log_problem", read.n_problems());
    let mut figures = color::plots(&run)?;
    figures.extend(particles.draw(&run)?);
    figures.push(color::film(&mut run, color::n_images(&records), &records, FILM_FRAMES)?);
    Ok(ReportRun { log: Some(name), figures, ..color::summarize(&mut run) })
}

/// Frames of the film strip.
const FILM_FRAMES: usize = 5;
