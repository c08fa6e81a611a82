use anyhow::Result;
use wayfix_appearance_cml::LocalizerParams;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::indoors::{IndoorDriveParams, RetailStore, RetailStoreParams};
use wayfix_systems::cml::PanoramaLocalizer;

use super::localize_trip::known_start;
use super::summary::{mean, mean_of, over_seeds};
use super::worlds::{Draw, robot, tour};
use super::{CmlExperimentSetup, SimulatedDriveResult, localize_trip};

/// People in 25 m × 10 m: almost every view shows a person.
const N_PEOPLE: usize = 12;

/// Whether people in view become part of the map: a crowded area with and without outlier rejection in the map, and the same area
/// empty.
/// # Errors
/// Returns an error if a drive cannot be simulated or followed.
pub(crate) fn crowded(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let seeds = over_seeds("crowded", setup, seed, |seed| one(setup, seed))?;
    let mut metrics: Vec<Metric> = Vec::new();
    for (name, at) in [("crowded", 0), ("crowded_all_learned", 1), ("empty", 2)] {
        let references =
            |courses: &[SimulatedDriveResult; 3]| courses[at].n_references.last().map_or(0.0, |n| *n as f64);
        metrics.extend(mean_of(&format!("n_references_{name}"), "", &seeds, references));
        metrics.extend(mean_of(&format!("error_mean_m_{name}"), "m", &seeds, |courses| {
            mean(&courses[at].errors)
        }));
    }
    let note = format!(
        "{} seeds; an area of 25 m × 10 m with {N_PEOPLE} people, {} m, empty map, raw odometry.",
        setup.n_seeds, setup.length_m
    );
    Ok(ReportRun { metrics, notes: vec![note], ..ReportRun::default() })
}

fn one(setup: &CmlExperimentSetup, seed: u64) -> Result<[SimulatedDriveResult; 3]> {
    let building = RetailStore::draw(RetailStoreParams::area(), &mut Draw::World.rng(seed))?.building();
    let through = |n_people, params: LocalizerParams| {
        let drive = IndoorDriveParams { robot: robot(seed), n_people, ..IndoorDriveParams::default() };
        let trip = tour(&building, setup.length_m, drive, (seed, 0))?;
        localize_trip(&mut PanoramaLocalizer::new(params, known_start(&trip)?)?, &trip)
    };
    let ours = setup.localizer;
    Ok([
        through(N_PEOPLE, ours)?,
        through(N_PEOPLE, LocalizerParams { skip_outlier_views_in_mapping: false, ..ours })?,
        through(0, ours)?,
    ])
}
