use anyhow::Result;
use wayfix_appearance_cml::{Learning, LocalizerParams};
use wayfix_scene_sim::indoors::{IndoorParams, Store, StoreParams};

use super::follow::{known_start, taught};
use super::histogram::histogram;
use super::summary::{largest, mean, mean_of, over_seeds};
use super::worlds::{Draw, robot, tour};
use super::{Course, Setup, follow};
use crate::cml::PanoramaLocalizer;
use crate::report::{Metric, Run};

/// Customers and employees in the store.
const N_PEOPLE: usize = 20;

/// Fig. 5: a map taught with true poses, four weeks later, while it stays as it is and while it is adapted.
///
/// # Errors
/// When a drive cannot be simulated or followed, or the picture not be drawn.
pub fn four_weeks(setup: &Setup, seed: u64) -> Result<Run> {
    let seeds = over_seeds(setup, seed, |seed| one(setup, seed))?;
    let mut metrics: Vec<Metric> = Vec::new();
    for (name, at) in [("static", 0), ("adapting", 1)] {
        let of = |courses: &[Course; 2], value: fn(&[f64]) -> f64| value(&courses[at].errors);
        metrics.extend(mean_of(&format!("error_mean_m_{name}"), "m", &seeds, |courses| of(courses, mean)));
        metrics.extend(mean_of(&format!("error_max_m_{name}"), "m", &seeds, |courses| of(courses, largest)));
        metrics.extend(mean_of(&format!("lost_{name}"), "", &seeds, |courses| courses[at].n_lost as f64));
        metrics.extend(mean_of(&format!("relocated_{name}"), "", &seeds, |courses| {
            courses[at].n_relocated as f64
        }));
    }
    let over_all =
        |at: usize| mean(&seeds.iter().map(|courses| mean(&courses[at].errors)).collect::<Vec<_>>());
    metrics.push(Metric::new("adapting_over_static", over_all(1) / over_all(0), ""));
    let errors =
        |at: usize| seeds.iter().flat_map(|courses: &[Course; 2]| courses[at].errors.clone()).collect();
    let plot = histogram(
        "Errors four weeks later",
        4.0,
        vec![("static map".to_owned(), errors(0)), ("adapting map".to_owned(), errors(1))],
    );
    let note = format!(
        "{} seeds; a store of 80 m × 50 m, {} m to learn, as much four weeks later, {:.0} % of the shelf sections rearranged, {N_PEOPLE} people.",
        setup.n_seeds,
        setup.length_m,
        100.0 * setup.rearranged
    );
    Ok(Run { metrics, figures: vec![plot.draw()?], notes: vec![note], ..Run::default() })
}

fn one(setup: &Setup, seed: u64) -> Result<[Course; 2]> {
    let store = Store::draw(StoreParams::home_store(), &mut Draw::World.rng(seed))?;
    let params = IndoorParams { drive: robot(seed), n_people: N_PEOPLE, ..IndoorParams::default() };
    let map = taught(&tour(&store.building(), setup.length_m, params, (seed, 0))?)?;
    let later = store.rearranged(setup.rearranged, &mut Draw::Rearranged(1).rng(seed))?;
    let trip = tour(&later.building(), setup.length_m, params, (seed, 1))?;
    let with = |learning| {
        let params = LocalizerParams { learning, ..setup.localizer };
        follow(&mut PanoramaLocalizer::with_map(params, map.clone(), known_start(&trip)?)?, &trip)
    };
    Ok([with(Learning::Static)?, with(Learning::Adapting)?])
}
