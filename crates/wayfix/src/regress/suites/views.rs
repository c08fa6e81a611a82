use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::Deserialize;
use wayfix_condensation::Picture;
use wayfix_scene_sim::scenery::{Scenery, Visit};

use super::super::Job;
use crate::{
    report::{Metric, Run},
    views::{self, FeatureKind, Normalization, PaperScene, RealScene, Setup, ViewSystem, ViewsParams},
};

/// What the plan says of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// What is done.
    #[serde(default)]
    experiment: Experiment,
    /// A composed scene, instead of `data`.
    scene: Option<String>,
    /// How it is seen.
    #[serde(default)]
    visit: VisitKind,
    /// The scene that was learned, beside the one of the run, when it is another picture.
    learn_from: Option<PathBuf>,
    /// How far the camera may have moved on the whole, pixels; that is measured and taken out.
    register: Option<usize>,
    /// Width and height of a view, pixels.
    #[serde(default = "view")]
    view: usize,
    /// Pixels between neighbouring views.
    #[serde(default = "step")]
    step: usize,
    /// How light is made that of learning; every way listed is driven.
    #[serde(default = "normalizations")]
    normalization: Vec<Normalization>,
    /// Drives of every feature.
    #[serde(default = "trials")]
    trials: u64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Experiment {
    /// Drives through a scene with each of the features.
    #[default]
    Drive,
    /// The paper's tables on a composed scene.
    Tables,
    /// Two ways to choose actions on a composed scene.
    Choices,
    /// A corridor that was driven twice.
    Corridor,
}

/// How a composed scene is seen.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum VisitKind {
    /// Gain, offset, gamma, noise and a shift.
    #[default]
    Dimmed,
    /// A response, a falloff and a cast of colour that no light model of ours has.
    OtherCamera,
}

impl Settings {
    fn scene(&self) -> Result<&str> {
        self.scene.as_deref().context("give `scene`, the name of a composed one")
    }
}

fn view() -> usize {
    128
}

fn step() -> usize {
    32
}

fn normalizations() -> Vec<Normalization> {
    vec![Normalization::WholeScene, Normalization::Online]
}

fn trials() -> u64 {
    100
}

/// An experiment with views.
pub(super) fn run(job: &Job<'_>) -> Result<Run> {
    let settings: Settings = job.planned.settings()?;
    match settings.experiment {
        Experiment::Drive => {
            let scenes = Scenes::read(job, &settings)?;
            drive(job, &settings, &scenes, |_, _| Ok(Vec::new()), |_, metric| metric)
        }
        Experiment::Tables => tables(job, &settings),
        Experiment::Choices => choices(job, &settings),
        Experiment::Corridor => views::corridor::run(job.log()?),
    }
}

/// The learned scene and the real one, and their views.
struct Scenes {
    learned: Picture,
    real: Picture,
    view: usize,
    step: usize,
}

impl Scenes {
    /// Pictures in files.
    fn read(job: &Job<'_>, settings: &Settings) -> Result<Self> {
        let path = job.log()?;
        let scene = views::read_scene(path)?.picture;
        let (learned, real) = match &settings.learn_from {
            Some(file) => {
                let learned = views::read_scene(&path.with_file_name(file))?.picture;
                let (dx, dy) =
                    settings.register.map_or((0, 0), |reach| views::mean_shift(&learned, &scene, reach));
                (learned, scene.shifted(-dx, -dy))
            }
            None => {
                let real = RealScene::default().of(&scene)?;
                (scene, real)
            }
        };
        Ok(Self { learned, real, view: settings.view, step: settings.step })
    }

    /// A composed scene.
    fn compose(settings: &Settings) -> Result<Self> {
        let scenery = Scenery::named(settings.scene()?)?;
        let visit = match settings.visit {
            VisitKind::Dimmed => Visit::dimmed(),
            VisitKind::OtherCamera => Visit::default(),
        };
        let (learned, real) = views::composed(&scenery, &visit)?;
        Ok(Self { learned, real, view: Scenery::VIEW_PX, step: scenery.step_px })
    }

    fn setup(&self, feature: FeatureKind, normalization: Normalization) -> Setup {
        Setup { view: self.view, step: self.step, feature, normalization }
    }
}

/// The paper's features with every normalization, on one scene. Figures are named after both; pictures are those of the last.
fn drive(
    job: &Job<'_>,
    settings: &Settings,
    scenes: &Scenes,
    statistics: impl Fn(&Setup, &ViewSystem) -> Result<Vec<Metric>>,
    beside: impl Fn(FeatureKind, Metric) -> Metric,
) -> Result<Run> {
    let (params, seed) = (ViewsParams::default(), job.options.seed);
    let mut all = Run {
        notes: vec!["The pictures are of the last feature and normalization.".to_owned()],
        ..Run::default()
    };
    let mut last = None;
    for &normalization in &settings.normalization {
        for feature in FeatureKind::OF_THE_PAPER {
            let setup = scenes.setup(feature, normalization);
            let run =
                views::run(&scenes.learned, &scenes.real, &setup, &params, settings.trials, seed, &|| ())?;
            let prefix = format!("{}_{}", feature.name(), normalization.name());
            let summary = views::summarize(&run);
            let named = |metric: Metric| {
                let metric = beside(feature, metric);
                Metric { name: format!("{prefix}_{}", metric.name), ..metric }
            };
            let is_told = |metric: &Metric| TOLD.contains(&metric.name.as_str());
            all.metrics.extend(summary.metrics.into_iter().filter(is_told).map(named));
            all.metrics.extend(statistics(&setup, &run.system)?.into_iter().map(named));
            let events = summary.events.into_iter().filter(|(name, n)| name != "arrived" && *n > 0);
            all.events.extend(events.map(|(name, n)| (format!("{prefix}_{name}"), n)));
            all.notes.extend(summary.notes.into_iter().map(|note| format!("{prefix}: {note}")));
            last = Some(run);
        }
    }
    if let Some(run) = last {
        all.figures = views::pictures(&run, &scenes.learned, &scenes.real, seed)?;
    }
    Ok(all)
}

/// The paper's three tables on a composed scene. Its figures stand beside ours with the whole scene normalized, which it presumes.
fn tables(job: &Job<'_>, settings: &Settings) -> Result<Run> {
    let scenes = Scenes::compose(settings)?;
    let paper = PaperScene::named(settings.scene()?);
    let statistics = |setup: &Setup, system: &ViewSystem| match setup.normalization {
        // The learned features of the first of many lights are not what a view is compared with.
        Normalization::Online => Ok(Vec::new()),
        Normalization::None | Normalization::WholeScene => Ok(views::p_value_metrics(system)?),
    };
    let beside = |feature, metric: Metric| match paper {
        Some(paper) => paper.beside(feature, metric),
        None => metric,
    };
    drive(job, settings, &scenes, statistics, beside)
}

/// Greedy and informed actions on the same drives through a composed scene.
fn choices(job: &Job<'_>, settings: &Settings) -> Result<Run> {
    let scenes = Scenes::compose(settings)?;
    let greedy = ViewsParams::default();
    let mut informed = greedy.clone();
    informed.navigator.choice = views::INFORMED;
    let mut metrics = Vec::new();
    for &normalization in &settings.normalization {
        for feature in FeatureKind::OF_THE_PAPER {
            let setup = scenes.setup(feature, normalization);
            let drive = |params| {
                views::run(
                    &scenes.learned,
                    &scenes.real,
                    &setup,
                    params,
                    settings.trials,
                    job.options.seed,
                    &|| (),
                )
            };
            let prefix = format!("{}_{}", feature.name(), normalization.name());
            let named = |metric: Metric| Metric { name: format!("{prefix}_{}", metric.name), ..metric };
            metrics
                .extend(views::compare_choices(&drive(&greedy)?, &drive(&informed)?).into_iter().map(named));
        }
    }
    Ok(Run { metrics, ..Run::default() })
}

/// Figures of a drive that the report shows.
const TOLD: [&str; 3] = ["successes", "steps_mean", "steps_to_certainty_mean"];
