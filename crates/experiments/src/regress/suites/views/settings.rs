use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::Deserialize;

use wayfix_systems::views::Normalization;

/// What the plan says of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    /// What is done.
    #[serde(default)]
    pub(super) experiment: Experiment,
    /// A composed scene, instead of `data`.
    pub(super) scene: Option<String>,
    /// How it is seen.
    #[serde(default)]
    pub(super) imaging_conditions: ImagingConditionsKind,
    /// The scene that was learned, beside the one of the run, when it is another picture.
    pub(super) learn_from: Option<PathBuf>,
    /// How far the camera may have moved on the whole, pixels; that is measured and taken out.
    pub(super) register: Option<usize>,
    /// Width and height of a view, pixels.
    #[serde(default = "view")]
    pub(super) view: usize,
    /// Pixels between neighbouring views.
    #[serde(default = "step")]
    pub(super) step: usize,
    /// How light is made that of learning; every way listed is driven.
    #[serde(default = "normalizations")]
    pub(super) normalization: Vec<Normalization>,
    /// Drives of every feature.
    #[serde(default = "trials")]
    pub(super) trials: u64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Experiment {
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
pub(super) enum ImagingConditionsKind {
    /// Gain, offset, gamma, noise and a shift.
    #[default]
    Dimmed,
    /// A response, a falloff and a cast of colour that no light model of ours has.
    OtherCamera,
}

impl Settings {
    pub(super) fn scene(&self) -> Result<&str> {
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
