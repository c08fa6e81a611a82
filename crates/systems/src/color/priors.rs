//! Priors of the colours, learned or read.

use std::path::Path;

use anyhow::{Context, Result};
use nalgebra::Vector3;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_model::{
    ColorMeans, LightingFilter, LightingFilterBank, LightingFilterParams, LightingPriors,
    PooledPixelVariance, PriorLearningParams, TrainingVenue, learn_priors,
};
use wayfix_kalman::MarkovChain;
use wayfix_scene_sim::league::{COLOR_NAMES, TrainingVenuesParams};
use wayfix_sensor_log::read_text;

use super::ColorSystemParams;

/// Dark and bright priors, learned from the 44 simulated venues of the four-legged league ([`learn_from_simulation`]).
const BUILT_IN: &str = include_str!("../../data/four-legged-priors.json");
/// Seed of the training venues; no log uses it.
const TRAINING_SEED: u64 = 2004;

/// The built-in priors for the colours of the four-legged league.
///
/// # Errors
/// None in practice; a test reads the priors.
pub fn built_in() -> Result<LightingPriors> {
    serde_json::from_str(BUILT_IN).context("the built-in priors are not usable")
}

/// Reads priors from a JSON file, as `--write-priors` writes them.
///
/// # Errors
/// Returns an error if the file cannot be read or is not valid JSON of this form.
pub fn read(path: &Path) -> Result<LightingPriors> {
    let text = read_text(path).with_context(|| format!("cannot read priors from {}", path.display()))?;
    serde_json::from_str(&text).with_context(|| format!("the priors in {} are not usable", path.display()))
}

/// Learns `k` priors from the simulated training venues, darkest first. The built-in priors were made with `k` = 2.
///
/// # Errors
/// Returns an error if learning fails.
pub fn learn_from_simulation(k: usize) -> Result<LightingPriors> {
    let venues: Vec<TrainingVenue> = TrainingVenuesParams::default()
        .gather(ChaCha8Rng::seed_from_u64(TRAINING_SEED))?
        .into_iter()
        .map(training_venue)
        .collect();
    let colors = COLOR_NAMES.map(str::to_owned);
    let mut rng = ChaCha8Rng::seed_from_u64(TRAINING_SEED + 1);
    Ok(learn_priors(&colors, &venues, k, &PriorLearningParams::default(), &mut rng)?)
}

fn training_venue(venue: wayfix_scene_sim::league::TrainingVenue) -> TrainingVenue {
    let image = |image: wayfix_scene_sim::league::ColorMeans| {
        let means = image.means.map(|mean| mean.map(Vector3::from));
        ColorMeans::new(means.into_iter().zip(image.counts.map(|count| count as u64)))
    };
    TrainingVenue {
        name: venue.name,
        images: venue.images.into_iter().map(image).collect(),
        pixels: Some(PooledPixelVariance {
            variances: Vector3::from(venue.pixel_variance),
            degrees_of_freedom: venue.degrees_of_freedom,
        }),
    }
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
