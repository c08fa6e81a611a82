use std::sync::Arc;

use anyhow::Result;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rayon::prelude::*;
use wayfix_color_map::ColorMap;
use wayfix_color_model::LightingFilterBank;
use wayfix_scene_sim::league::LeagueParams;
use wayfix_scene_sim::random::RandomStreams;
use wayfix_sensor_log::Record;

use wayfix_evaluation::{
    errors::MeanInterval,
    report::{Metric, ReportRun},
};
use wayfix_systems::color::{ColorRunSetup, ColorSystemParams, run, summarize};

/// A drive in random halls: means over halls with 95 % intervals.
/// # Errors
/// Returns an error if a log cannot be simulated or no image used.
pub(crate) fn other_halls(
    seeds: impl IntoIterator<Item = u64>,
    drive_params: &LeagueParams,
    map: &Arc<ColorMap>,
    bank: &LightingFilterBank,
    params: &ColorSystemParams,
) -> Result<ReportRun> {
    let seeds: Vec<u64> = seeds.into_iter().collect();
    let runs: Vec<ReportRun> = seeds
        .par_iter()
        .map(|&seed| {
            let mut run =
                run(&drive(seed, drive_params)?, ColorRunSetup::new(map, bank, params, seed), |_| {})?;
            Ok(summarize(&mut run))
        })
        .collect::<Result<_>>()?;
    let value = |run: &ReportRun, name: &str| run.metrics.iter().find(|m| m.name == name).map(|m| m.value);
    let mut metrics = vec![Metric::new("n_halls", seeds.len() as f64, "")];
    let rates = map.colors().iter().map(|color| (format!("classification_rate_{color}"), ""));
    let errors =
        [("position_mean_m", "m"), ("heading_mean_deg", "°"), ("dead_reckoning_position_error_mean_m", "m")];
    let overall = [("classification_rate", "")];
    let named = overall.into_iter().chain(errors).map(|(name, unit)| (name.to_owned(), unit));
    for (name, unit) in named.chain(rates) {
        let values: Vec<f64> = runs.iter().filter_map(|run| value(run, &name)).collect();
        if let Some(mean) = MeanInterval::of(&values) {
            metrics.extend(Metric::of_mean(&name, &mean, unit));
        }
    }
    let worst = runs.iter().filter_map(|run| value(run, "position_mean_m")).fold(0.0, f64::max);
    metrics.push(Metric::new("worst_hall_position_mean_m", worst, "m"));
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

/// The log of a drive in a hall of its own.
pub(super) fn drive(seed: u64, params: &LeagueParams) -> Result<Vec<Record>> {
    Ok(params.simulate(RandomStreams::new(ChaCha8Rng::seed_from_u64(seed)))?)
}
