use anyhow::{Result, bail};
use nalgebra::Vector2;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use wayfix_appearance_cml::StartPosePrior;
use wayfix_evaluation::errors::proportion_interval;
use wayfix_evaluation::plot::LinePlot;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::indoors::{Building, IndoorDriveParams, RetailStore, RetailStoreParams};
use wayfix_scene_sim::route::Route;
use wayfix_systems::cml::{PanoramaLocalizer, PanoramaMap};

use super::localize_trip::{known_start, taught};
use super::summary::over_seeds;
use super::worlds::{Draw, robot, tour};
use super::{CmlExperimentSetup, SimulatedDrive, SimulatedDriveResult, localize_trip};
use crate::error_quantiles::error_quantiles;

/// A run has succeeded that ends this near, metres.
const NEAR_M: f64 = 1.0;
/// Distance within which the robot must localize itself, m.
const TRAVEL_M: f64 = 20.0;
/// Way between two views, metres, about.
const VIEW_M: f64 = 0.25;
/// Distance for which a kidnapped robot is followed, m: the previous hypothesis is kept for 20 m after the relocalization.
const FOLLOWED_M: f64 = 80.0;
/// Error after a relocalization that counts as divergence, m: across an aisle.
const DIVERGED_M: f64 = 3.0;
/// Runs in each store: a map takes far longer to learn than a run.
const RUNS_PER_STORE: u64 = 10;
const REARRANGED: f64 = 0.1;
const N_PEOPLE: usize = 20;
/// Maximum distance of a drive in known ground from the training poses, m: the width of an aisle, in which a robot stays within 0.4 m of the
/// middle. A place without training views cannot be recognized, and 2 000 m do not cover all aisles of a store.
const KNOWN_M: f64 = 1.0;
/// Drives that are drawn at most until one is in known ground.
const MOST_DRAWS: usize = 1000;

/// Number of runs with an unknown start in known stores that end near the truth after 20 m.
/// # Errors
/// Returns an error if a drive cannot be simulated or followed, or the picture not be drawn.
pub(crate) fn global_start(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let courses = in_stores(setup, seed, |map, later, at| {
        let trip = away(later, map, at, TRAVEL_M)?;
        localize_trip(
            &mut PanoramaLocalizer::with_map(setup.localizer, map.clone(), StartPosePrior::Anywhere)?,
            &trip,
        )
    })?;
    report("Global localization", setup, &courses)
}

/// Number of kidnapped robots, after 20 m of correct tracking, that end near the truth after another 20 m.
/// # Errors
/// Returns the errors of [`global_start`].
pub(crate) fn kidnapped(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    report("Error after a kidnapping", setup, &kidnapped_results(setup, seed, TRAVEL_M)?)
}

/// Number of kidnapped and relocalized robots that diverge in the next 60 m: to the pose that they would have without the kidnapping, or to
/// another place.
/// # Errors
/// Returns the errors of [`global_start`].
pub(crate) fn after_relocalization(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let courses = kidnapped_results(setup, seed, FOLLOWED_M)?;
    let after = |course: &SimulatedDriveResult| {
        course.errors.get((TRAVEL_M / VIEW_M) as usize..).map(<[f64]>::to_vec)
    };
    let mut found: Vec<Vec<f64>> = courses.iter().filter_map(after).collect();
    found.retain(|errors| errors.first().is_some_and(|error| *error <= NEAR_M));
    let n_diverged = found.iter().filter(|errors| errors.iter().any(|error| *error > DIVERGED_M)).count();
    let n_diverged_at_end =
        found.iter().filter(|errors| errors.last().is_some_and(|error| *error > DIVERGED_M)).count();
    // Without relocalizations the share is NaN, and no bound holds.
    let share = |n: usize| n as f64 / found.len() as f64;
    let (low, high) = proportion_interval(n_diverged as u64, found.len() as u64);
    let metrics = vec![
        Metric::new("trials", courses.len() as f64, ""),
        Metric::new("n_relocalized_trials", found.len() as f64, ""),
        Metric::new("diverged_after_relocalization_share", share(n_diverged), ""),
        Metric::new("diverged_after_relocalization_share_low95", low, ""),
        Metric::new("diverged_after_relocalization_share_high95", high, ""),
        Metric::new("diverged_at_end_share", share(n_diverged_at_end), ""),
    ];
    let note = format!(
        "{} kidnapped robots; {} are within {NEAR_M} m after {TRAVEL_M} m. Diverged: error above {DIVERGED_M} m at some time up to {FOLLOWED_M} m. Stores as for `kidnapped`; routes are longer and different.",
        courses.len(),
        found.len()
    );
    let figures = vec![quantiles("Error after a kidnapping, with a longer drive", &courses).draw()?];
    Ok(ReportRun { metrics, figures, notes: vec![note], ..ReportRun::default() })
}

/// Robots that are tracked for 20 m, and then kidnapped to the start of a drive of `length_m`.
fn kidnapped_results(
    setup: &CmlExperimentSetup,
    seed: u64,
    length_m: f64,
) -> Result<Vec<SimulatedDriveResult>> {
    in_stores(setup, seed, |map, later, at| {
        let before = away(later, map, (at.0, at.1 + 1000), TRAVEL_M)?;
        let after = away(later, map, at, length_m)?;
        let mut localizer = PanoramaLocalizer::with_map(setup.localizer, map.clone(), known_start(&before)?)?;
        localize_trip(&mut localizer, &before)?;
        localize_trip(&mut localizer, &after)
    })
}

/// Several runs in each store, some days after its map was taught.
fn in_stores(
    setup: &CmlExperimentSetup,
    seed: u64,
    run: impl Fn(&PanoramaMap, &Building, (u64, u64)) -> Result<SimulatedDriveResult> + Sync,
) -> Result<Vec<SimulatedDriveResult>> {
    let stores = CmlExperimentSetup { n_seeds: setup.n_seeds.div_ceil(RUNS_PER_STORE), ..*setup };
    let courses = over_seeds("relocalization", &stores, seed, |seed| {
        let store = RetailStore::draw(RetailStoreParams::home_store(), &mut Draw::World.rng(seed))?;
        let params =
            IndoorDriveParams { robot: robot(seed), n_people: N_PEOPLE, ..IndoorDriveParams::default() };
        let map = taught(&tour(&store.building(), setup.length_m, params, (seed, 0))?)?;
        let later = store.rearranged(REARRANGED, &mut Draw::Rearranged(1).rng(seed))?.building();
        let n_runs = RUNS_PER_STORE.min(setup.n_seeds);
        (1..=n_runs).into_par_iter().map(|visit| run(&map, &later, (seed, visit))).collect::<Result<Vec<_>>>()
    })?;
    Ok(courses.into_iter().flatten().collect())
}

/// A drive from a random crossing, through aisles of the map.
fn away(
    building: &Building,
    map: &PanoramaMap,
    (seed, visit): (u64, u64),
    length_m: f64,
) -> Result<SimulatedDrive> {
    let mut rng = Draw::Visit(visit).rng(seed);
    let route = known_route(building, map, length_m, &mut rng)?;
    let params = IndoorDriveParams { robot: robot(seed), n_people: N_PEOPLE, ..IndoorDriveParams::default() };
    let mut trip = SimulatedDrive::drive(building, route, params, Draw::Visit(visit).streams(seed))?;
    let mut travelled_m = 0.0;
    trip.steps.retain(|step| {
        travelled_m += step.odometry.map_or(0.0, |moved| moved.translation.norm());
        travelled_m <= length_m
    });
    Ok(trip)
}

fn known_route(building: &Building, map: &PanoramaMap, length_m: f64, rng: &mut ChaCha8Rng) -> Result<Route> {
    let taught = || map.references().values().flat_map(|reference| &reference.places);
    let is_known =
        |at: Vector2<f64>| taught().any(|place| (place.gaussian.mean().translation - at).norm() <= KNOWN_M);
    let crossings = building.aisles().crossings();
    for _ in 0..MOST_DRAWS {
        let start = crossings[rng.random_range(0..crossings.len())];
        let route = building.aisles().tour_from(start, length_m, rng)?;
        let mut points = (0..=length_m as usize).map(|metre| route.at(metre as f64).translation);
        if points.all(is_known) {
            return Ok(route);
        }
    }
    bail!("no drive of {length_m} m through known aisles in {MOST_DRAWS} draws")
}

fn report(title: &str, setup: &CmlExperimentSetup, courses: &[SimulatedDriveResult]) -> Result<ReportRun> {
    let n = courses.len();
    let near = |course: &&SimulatedDriveResult| course.errors.last().is_some_and(|error| *error <= NEAR_M);
    let n_near = courses.iter().filter(near).count();
    let (low, high) = proportion_interval(n_near as u64, n as u64);
    let metrics = vec![
        Metric::new("trials", n as f64, ""),
        Metric::new("success_share", n_near as f64 / n.max(1) as f64, ""),
        Metric::new("success_share_low95", low, ""),
        Metric::new("success_share_high95", high, ""),
    ];
    let note = format!(
        "{n} runs of {TRAVEL_M} m, {RUNS_PER_STORE} a store of 80 m × 50 m with a map taught along {} m. {:.0} % of the shelf sections are rearranged since, in taught aisles. Success: within {NEAR_M} m at the end.",
        setup.length_m,
        100.0 * REARRANGED
    );
    Ok(ReportRun {
        metrics,
        figures: vec![quantiles(title, courses).draw()?],
        notes: vec![note],
        ..ReportRun::default()
    })
}

fn quantiles(title: &str, courses: &[SimulatedDriveResult]) -> LinePlot {
    let n_steps = courses.iter().map(|course| course.errors.len()).min().unwrap_or(0);
    error_quantiles(title, "travelled, m", n_steps, |step| {
        let errors = courses.iter().map(|course| course.errors[step].min(99.0));
        (VIEW_M * step as f64, errors.collect())
    })
}
