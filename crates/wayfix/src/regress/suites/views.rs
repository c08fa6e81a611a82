use std::path::PathBuf;

use anyhow::Result;
use serde::Deserialize;

use super::super::Job;
use crate::{
    report::{Metric, Run},
    views::{self, FeatureKind, Normalization, RealScene, Setup, ViewsParams},
};

/// What the plan says of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Settings {
    /// What is done.
    #[serde(default)]
    experiment: Experiment,
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
    /// A corridor that was driven twice.
    Corridor,
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
        Experiment::Drive => drive(job, &settings),
        Experiment::Corridor => views::corridor::run(job.log()?),
    }
}

/// The paper's features with every normalization, on one scene. Figures are named after both; pictures are those of the last.
fn drive(job: &Job<'_>, settings: &Settings) -> Result<Run> {
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
    let (params, seed) = (ViewsParams::default(), job.options.seed);
    let mut all = Run {
        notes: vec!["The pictures are of the last feature and normalization.".to_owned()],
        ..Run::default()
    };
    let mut last = None;
    for &normalization in &settings.normalization {
        for feature in FeatureKind::OF_THE_PAPER {
            let setup = Setup { view: settings.view, step: settings.step, feature, normalization };
            let run = views::run(&learned, &real, &setup, &params, settings.trials, seed, &|| ())?;
            let prefix = format!("{}_{}", feature.name(), normalization.name());
            let summary = views::summarize(&run);
            let named = |metric: Metric| Metric { name: format!("{prefix}_{}", metric.name), ..metric };
            let is_told = |metric: &Metric| TOLD.contains(&metric.name.as_str());
            all.metrics.extend(summary.metrics.into_iter().filter(is_told).map(named));
            let events = summary.events.into_iter().filter(|(name, n)| name != "arrived" && *n > 0);
            all.events.extend(events.map(|(name, n)| (format!("{prefix}_{name}"), n)));
            all.notes.extend(summary.notes.into_iter().map(|note| format!("{prefix}: {note}")));
            last = Some(run);
        }
    }
    if let Some(run) = last {
        all.figures = views::pictures(&run, &learned, &real, seed)?;
    }
    Ok(all)
}

/// Figures of a drive that the report shows.
const TOLD: [&str; 3] = ["successes", "steps_mean", "steps_to_certainty_mean"];
