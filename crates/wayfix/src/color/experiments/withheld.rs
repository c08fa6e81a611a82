use std::sync::Arc;

use anyhow::Result;
use rayon::prelude::*;
use wayfix_color_map::{ColorId, ColorMap};
use wayfix_color_model::LightingPriors;
use wayfix_sensor_log::Record;

use crate::{
    color::{ColorRun, ColorSystemParams, priors, rate_of, run},
    evaluate::MeanInterval,
    report::{Metric, Run},
};

/// Fewer labelled pixels of a colour in an image give no rate of their own.
const MIN_PIXELS: u64 = 20;

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
    let priors = [("joint", learned.clone()), ("independent", learned.independent())];
    let cases: Vec<(usize, &str, &LightingPriors)> = (0..map.colors().len())
        .flat_map(|color| priors.iter().map(move |(name, priors)| (color, *name, priors)))
        .collect();
    let rates: Vec<Option<MeanInterval>> = cases
        .par_iter()
        .map(|(color, _, priors)| {
            let mut params = params.clone();
            params.localizer.withheld = Some(*color);
            let bank = priors::bank(priors, &params)?;
            let run = run(records, Arc::clone(map), bank, &params, None, seed, |_| {})?;
            Ok(rate(&run, ColorId(*color as u8)))
        })
        .collect::<Result<_>>()?;
    let mut metrics = Vec::new();
    for (color, name) in map.colors().iter().enumerate() {
        if let [Some(joint), Some(independent)] = rates[2 * color..2 * color + 2] {
            for (kind, rate) in [("joint", joint), ("independent", independent)] {
                metrics.push(Metric::new(format!("{name}_{kind}"), rate.mean, ""));
                metrics.push(Metric::new(format!("{name}_{kind}_ci95"), rate.half_width, ""));
            }
            metrics.push(Metric::new(format!("{name}_gain"), joint.mean - independent.mean, ""));
        }
    }
    Ok(Run { metrics, ..Run::default() })
}

fn rate(run: &ColorRun, color: ColorId) -> Option<MeanInterval> {
    let labelled = run.system.frames().iter().filter_map(|frame| frame.labelled.as_ref());
    MeanInterval::of(&rate_of(labelled, color, MIN_PIXELS))
}
