use std::sync::Arc;

use anyhow::Result;
use rayon::prelude::*;
use wayfix_color_map::{ColorId, ColorMap};
use wayfix_color_model::LightingPriors;
use wayfix_scene_sim::league::Lighting;
use wayfix_sensor_log::Record;

use super::halls::drive;
use crate::{
    color::{ColorRun, ColorSystemParams, priors, rate_of, run},
    evaluate::MeanInterval,
    report::{Metric, Run},
};

/// Fewer labelled pixels of a colour in an image give no rate of their own.
const MIN_PIXELS: u64 = 20;

/// How well each withheld colour is recognized with the joint prior and with the independent one; `None` for a colour that no image shows.
type Rates = Vec<[Option<MeanInterval>; 2]>;

/// Table 1 of [Schulz & Fox 2004], its lower half: each colour withheld from the lighting filter in turn, and how well it is recognized all the same,
/// from what the other colours tell (joint prior) or from its prior alone (independent: all correlations between colours set to zero).
///
/// # Errors
/// When no image of the log can be used.
pub fn withheld(
    records: &[Record],
    map: &Arc<ColorMap>,
    learned: &LightingPriors,
    params: &ColorSystemParams,
    seed: u64,
) -> Result<Run> {
    let mut metrics = Vec::new();
    for (name, rates) in map.colors().iter().zip(rates(records, map, learned, params, seed)?) {
        if let [Some(joint), Some(independent)] = rates {
            metrics.extend(Metric::of_mean(&format!("{name}_joint"), &joint, ""));
            metrics.extend(Metric::of_mean(&format!("{name}_independent"), &independent, ""));
            metrics.push(Metric::new(format!("{name}_gain"), joint.mean - independent.mean, ""));
        }
    }
    Ok(Run { metrics, ..Run::default() })
}

/// The same in halls that were not picked: means over halls with 95 % intervals, the gain of the joint prior from differences in the same hall.
///
/// # Errors
/// When a log cannot be simulated or no image used.
pub fn withheld_in_halls(
    seeds: impl IntoIterator<Item = u64>,
    lighting: Lighting,
    map: &Arc<ColorMap>,
    learned: &LightingPriors,
    params: &ColorSystemParams,
) -> Result<Run> {
    let halls: Vec<Rates> = seeds
        .into_iter()
        .map(|seed| rates(&drive(seed, lighting)?, map, learned, params, seed))
        .collect::<Result<_>>()?;
    let mut metrics = vec![Metric::new("n_halls", halls.len() as f64, "")];
    for (color, name) in map.colors().iter().enumerate() {
        let means = |hall: &Rates| match hall[color] {
            [Some(joint), Some(independent)] => Some((joint.mean, independent.mean)),
            _ => None,
        };
        let (joint, independent): (Vec<f64>, Vec<f64>) = halls.iter().filter_map(means).unzip();
        let gain: Vec<f64> = joint.iter().zip(&independent).map(|(joint, alone)| joint - alone).collect();
        for (kind, values) in [("joint", joint), ("independent", independent), ("gain", gain)] {
            if let Some(mean) = MeanInterval::of(&values) {
                metrics.extend(Metric::of_mean(&format!("{name}_{kind}"), &mean, ""));
                if kind == "gain" {
                    let low = mean.mean - mean.half_width;
                    metrics.push(Metric::new(format!("{name}_gain_low95"), low, ""));
                }
            }
        }
    }
    Ok(Run { metrics, ..Run::default() })
}

fn rates(
    records: &[Record],
    map: &Arc<ColorMap>,
    learned: &LightingPriors,
    params: &ColorSystemParams,
    seed: u64,
) -> Result<Rates> {
    let kinds = [learned.clone(), learned.independent()];
    let cases: Vec<(usize, usize)> =
        (0..map.colors().len()).flat_map(|color| [(color, 0), (color, 1)]).collect();
    let rates: Vec<Option<MeanInterval>> = cases
        .par_iter()
        .map(|&(color, kind)| {
            let mut params = params.clone();
            params.localizer.withheld = Some(color);
            let bank = priors::bank(&kinds[kind], &params)?;
            let run = run(records, Arc::clone(map), bank, &params, None, seed, |_| {})?;
            Ok(rate(&run, ColorId(color as u8)))
        })
        .collect::<Result<_>>()?;
    Ok(rates.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
}

fn rate(run: &ColorRun, color: ColorId) -> Option<MeanInterval> {
    let labelled = run.system.frames().iter().filter_map(|frame| frame.labelled.as_ref());
    MeanInterval::of(&rate_of(labelled, color, MIN_PIXELS))
}
