//! Priors of the colours, learned or read.

use std::path::Path;

use anyhow::{Context, Result};
use nalgebra::Vector3;
use wayfix_color_model::{LightingFilter, LightingFilterBank, LightingFilterParams, LightingPriors};
use wayfix_kalman::MarkovChain;
use wayfix_sensor_log::read_text;

use super::ColorSystemParams;

/// Dark and bright priors, learned from 44 simulated venues of the four-legged league by `wayfix-experiments fixtures priors`.
const BUILT_IN: &str = include_str!("../../data/four-legged-priors.json");
const BROAD: &str = include_str!("../../data/broad-priors.json");

/// The built-in priors for the colours of the four-legged league.
///
/// # Errors
/// None in practice; a test reads the priors.
pub fn built_in() -> Result<LightingPriors> {
    serde_json::from_str(BUILT_IN).context("the built-in priors are not usable")
}

/// The priors of a light and a camera of which nothing is known, by `wayfix-experiments fixtures priors --broad`. Errors as of [`built_in`].
pub fn broad() -> Result<LightingPriors> {
    serde_json::from_str(BROAD).context("the broad priors are not usable")
}

/// Reads priors from a JSON file, as `--write-priors` writes them.
///
/// # Errors
/// Returns an error if the file cannot be read or is not valid JSON of this form.
pub fn read(path: &Path) -> Result<LightingPriors> {
    let text = read_text(path).with_context(|| format!("cannot read priors from {}", path.display()))?;
    serde_json::from_str(&text).with_context(|| format!("the priors in {} are not usable", path.display()))
}

/// A bank with one lighting filter per prior, with a Markov chain that rarely switches.
///
/// # Errors
/// Returns an error if a prior or a parameter is invalid.
pub fn bank(priors: &LightingPriors, params: &ColorSystemParams) -> Result<LightingFilterBank> {
    let lighting = LightingFilterParams {
        pixel_color_variance: params
            .pixel_color_variance
            .map_or(priors.pixel_color_variance(), Vector3::from),
        mean_color_variance: params.mean_color_variance.map_or(priors.mean_color_variance(), Vector3::from),
        lighting_drift: params.lighting_drift,
        unseen_colors: params.unseen_colors,
    };
    let filters = priors.members().iter().map(|prior| LightingFilter::new(prior.clone(), lighting));
    let chain = MarkovChain::sticky(priors.members().len(), params.light_persistence)?;
    Ok(LightingFilterBank::new(filters.collect::<Result<_, _>>()?, chain)?)
}
