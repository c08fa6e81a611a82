use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::Deserialize;

use wayfix_systems::views::{LightNormalization, ViewsParams};

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    /// The experiment.
    #[serde(default)]
    pub(super) experiment: Experiment,
    /// A composed scene, instead of `data`.
    pub(super) scene: Option<String>,
    /// The imaging conditions.
    #[serde(default)]
    pub(super) imaging_conditions: ImagingConditionsKind,
    /// Image of the learned scene, if it differs from that of the run.
    pub(super) learn_from: Option<PathBuf>,
    /// Maximum mean camera shift that is estimated and removed, pixels.
    pub(super) register: Option<usize>,
    /// Width and height of a view, pixels.
    #[serde(default = "view")]
    pub(super) view: usize,
    /// Pixels between neighbouring views.
    #[serde(default = "step")]
    pub(super) step: usize,
    /// Normalizations of the light; each one listed is run.
    #[serde(default = "normalizations")]
    pub(super) normalization: Vec<LightNormalization>,
    /// The method as published, without the additions.
    #[serde(default)]
    pub(super) as_published: bool,
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
    /// The same with actions from the order of the frames.
    CorridorLog,
}

/// Imaging conditions of a composed scene.
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
    pub(super) fn params(&self) -> ViewsParams {
        if self.as_published { ViewsParams::as_published() } else { ViewsParams::default() }
    }

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

fn normalizations() -> Vec<LightNormalization> {
    vec![LightNormalization::WholeScene, LightNormalization::Online]
}

fn trials() -> u64 {
    100
}
