use anyhow::Result;
use wayfix_scene_sim::indoors::{IndoorParams, Store, StoreParams};

use super::follow::{known_start, taught};
use super::worlds::{Draw, robot, tour};
use super::{Setup, Trip, follow};
use crate::cml::PanoramaLocalizer;
use crate::plot::{LinesPlot, Scale, Series};
use crate::report::{Metric, Run};

/// Numbers of references.
const N_REFERENCES: [usize; 5] = [1000, 3000, 10_000, 30_000, 100_000];
/// Steps that are timed in each map.
const N_STEPS: usize = 200;

/// Computing time of a step against the number of references. Times change from call to call, and other runs of a report go on beside this one.
///
/// # Errors
/// When a drive cannot be simulated or followed, or the picture not be drawn.
pub fn step_time(setup: &Setup, seed: u64) -> Result<Run> {
    let seed = setup.seeds(seed).start;
    let shape = StoreParams { length_m: 240.0, width_m: 150.0, n_blocks: 9, ..StoreParams::home_store() };
    let building = Store::draw(shape, &mut Draw::World.rng(seed))?.building();
    let params = IndoorParams { drive: robot(seed), n_people: 20, ..IndoorParams::default() };
    let learned = tour(&building, setup.length_m, params, (seed, 0))?;
    let mut again = tour(&building, 0.25 * N_STEPS as f64, params, (seed, 1))?;
    again.steps.truncate(N_STEPS);
    let mut points = Vec::new();
    for n in N_REFERENCES.into_iter().filter(|n| *n <= learned.steps.len()) {
        let part = Trip { steps: learned.steps[..n].to_vec() };
        let mut localizer =
            PanoramaLocalizer::with_map(setup.localizer, taught(&part)?, known_start(&again)?)?;
        let mut steps = follow(&mut localizer, &again)?.step_s;
        steps.sort_by(f64::total_cmp);
        points.push((n as f64, 1e3 * steps[steps.len() / 2]));
    }
    let timings =
        points.iter().map(|(n, ms)| Metric::new(format!("step_median_ms_{n}"), *ms, "ms")).collect();
    let plot = LinesPlot {
        title: "Computing time of a step".to_owned(),
        x_label: "references".to_owned(),
        y_label: "ms".to_owned(),
        series: vec![Series::new(format!("median of {N_STEPS} steps"), points)],
        x_scale: Scale::Log10,
        y_scale: Scale::Log10,
        ..LinesPlot::default()
    };
    Ok(Run { timings, figures: vec![plot.draw()?], ..Run::default() })
}
