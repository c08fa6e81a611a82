use std::sync::Arc;

use anyhow::{Result, ensure};
use rayon::prelude::*;
use wayfix_color_map::{ColorId, ColorMap};
use wayfix_color_model::LightingPriors;
use wayfix_evaluation::{
    errors::MeanInterval,
    report::{Metric, ReportRun},
};
use wayfix_scene_sim::league::LeagueParams;
use wayfix_sensor_log::Record;
use wayfix_systems::color::{ColorRunSetup, ColorSystemParams, priors, rate_of, run};

use super::halls::drive;

/// Minimum number of labelled pixels of a colour in an image for a rate of its own.
const MIN_PIXELS: u64 = 20;

/// Classification rates of a withheld colour per image: with the joint prior and with the independent one.
type Rates = [Vec<f64>; 2];

/// The lower half of [Schulz & Fox 2004, Table 1]: each colour is withheld from the lighting filter in turn. Its classification rate then
/// depends on the
/// other colours (joint prior) or on its prior alone (independent: all correlations between colours set to zero). Means over the images of the log
/// with 95 % intervals; the gain of the joint prior is from differences in the same image.
/// # Errors
/// Returns an error if no image of the log can be used.
pub(crate) fn withheld(
    records: &[Record],
    map: &Arc<ColorMap>,
    learned: &LightingPriors,
    params: &ColorSystemParams,
    seed: u64,
) -> Result<ReportRun> {
    let rates = rates(records, map, learned, params, seed)?;
    let metrics = map.colors().iter().zip(&rates).flat_map(|(name, rates)| compared(name, rates)).collect();
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

/// The same in random halls: means over halls with 95 % intervals, the gain of the joint prior from differences in the same hall.
/// # Errors
/// Returns an error if a log cannot be simulated or no image used.
pub(crate) fn withheld_in_halls(
    seeds: impl IntoIterator<Item = u64>,
    drive_params: &LeagueParams,
    map: &Arc<ColorMap>,
    learned: &LightingPriors,
    params: &ColorSystemParams,
) -> Result<ReportRun> {
    let halls: Vec<Vec<Rates>> = seeds
        .into_iter()
        .map(|seed| rates(&drive(seed, drive_params)?, map, learned, params, seed))
        .collect::<Result<_>>()?;
    let mut metrics = vec![Metric::new("n_halls", halls.len() as f64, "")];
    for (color, name) in map.colors().iter().enumerate() {
        let mean_of = |rates: &Vec<f64>| MeanInterval::of(rates).map(|interval| interval.mean);
        let means = |hall: &Vec<Rates>| Some((mean_of(&hall[color][0])?, mean_of(&hall[color][1])?));
        let (joint, independent) = halls.iter().filter_map(means).unzip();
        metrics.extend(compared(name, &[joint, independent]));
    }
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

/// Both rates and their paired difference, each a mean with its interval; empty for a colour that is rarely shown.
pub(crate) fn compared(name: &str, [joint, independent]: &Rates) -> Vec<Metric> {
    let gain = joint.iter().zip(independent).map(|(joint, alone)| joint - alone).collect::<Vec<f64>>();
    let mean_of = |what: &str, values: &[f64]| {
        MeanInterval::of(values).map(|mean| {
            (Metric::of_mean(&format!("withheld_{name}_classification_rate_{what}"), &mean, ""), mean)
        })
    };
    let all = [
        mean_of("joint_prior", joint),
        mean_of("independent_prior", independent),
        mean_of("joint_minus_independent", &gain),
    ];
    let [Some((joint, _)), Some((independent, _)), Some((gain, mean))] = all else { return Vec::new() };
    let low = Metric::new(
        format!("withheld_{name}_classification_rate_joint_minus_independent_low95"),
        mean.mean - mean.half_width,
        "",
    );
    joint.into_iter().chain(independent).chain(gain).chain([low]).collect()
}

fn rates(
    records: &[Record],
    map: &Arc<ColorMap>,
    learned: &LightingPriors,
    params: &ColorSystemParams,
    seed: u64,
) -> Result<Vec<Rates>> {
    let kinds = [learned.clone(), learned.independent()];
    let cases: Vec<(usize, usize)> =
        (0..map.colors().len()).flat_map(|color| [(color, 0), (color, 1)]).collect();
    let rates: Vec<Vec<f64>> = cases
        .par_iter()
        .map(|&(color, kind)| {
            let mut params = params.clone();
            params.localizer.withheld_color = Some(color);
            let bank = priors::bank(&kinds[kind], &params)?;
            let run = run(records, ColorRunSetup::new(map, &bank, &params, seed), |_| {})?;
            let labelled = run.system.frames().iter().filter_map(|frame| frame.labelled.as_ref());
            Ok(rate_of(labelled, ColorId(color as u8), MIN_PIXELS))
        })
        .collect::<Result<_>>()?;
    let mut rates = rates.into_iter();
    let pairs: Vec<Rates> = std::iter::from_fn(|| Some([rates.next()?, rates.next()?])).collect();
    // Images are paired by order: one usable in only one of the two would shift all others.
    ensure!(
        pairs.iter().all(|[joint, independent]| joint.len() == independent.len()),
        "an image was used with one prior only"
    );
    Ok(pairs)
}
