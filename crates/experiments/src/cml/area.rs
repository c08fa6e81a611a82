use anyhow::Result;
use wayfix_appearance_cml::LocalizerParams;
use wayfix_evaluation::plot::MapPlot;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::indoors::{Building, IndoorDriveParams, RetailStore, RetailStoreParams};
use wayfix_scene_sim::world::SensorWorld;
use wayfix_systems::cml::PanoramaLocalizer;

use super::localize_trip::known_start;
use super::summary::{largest, mean, mean_of, over_seeds, ratio_of};
use super::worlds::{Draw, robot};
use super::{CmlExperimentSetup, SimulatedDrive, SimulatedDriveResult, localize_trip};

/// Laps around the shelves. [Gross et al. 2005, Fig. 4]
const N_LAPS: usize = 7;

struct Lapped {
    building: Building,
    trip: SimulatedDrive,
    course: SimulatedDriveResult,
    /// The same with the method as published.
    published: SimulatedDriveResult,
}

/// Seven laps around shelves from an empty map, raw odometry. [Gross et al. 2005, Fig. 4] Length and share of the setup play no part.
///
/// # Errors
/// Returns an error if a drive cannot be simulated or followed, or the picture not be drawn.
pub(crate) fn laps(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let seeds = over_seeds("laps", setup, seed, |seed| one(setup, seed))?;
    let mut metrics: Vec<Metric> = Vec::new();
    metrics.extend(mean_of("error_mean_m", "m", &seeds, |lapped| mean(&lapped.course.errors)));
    metrics.extend(mean_of("error_max_m", "m", &seeds, |lapped| largest(&lapped.course.errors)));
    metrics
        .extend(mean_of("error_mean_m_as_published", "m", &seeds, |lapped| mean(&lapped.published.errors)));
    metrics.extend(mean_of("dead_reckoning_error_mean_m", "m", &seeds, |lapped| {
        mean(&dead_reckoning_errors(&lapped.trip))
    }));
    let error = |lap: usize| move |lapped: &Lapped| mean(of_lap(&lapped.course, lap));
    for (name, lap) in [("first", 0), ("second", 1), ("last", N_LAPS - 1)] {
        metrics.extend(mean_of(&format!("error_mean_m_{name}_lap"), "m", &seeds, error(lap)));
    }
    metrics.extend(ratio_of("error_mean_ratio_last_over_first_lap", &seeds, error(N_LAPS - 1), error(0)));
    metrics.extend(ratio_of("error_mean_ratio_last_over_second_lap", &seeds, error(N_LAPS - 1), error(1)));
    metrics.extend(mean_of("n_references", "", &seeds, |lapped| {
        lapped.course.n_references.last().map_or(0.0, |n| *n as f64)
    }));
    let figures = seeds.first().map(|lapped| path(lapped).draw()).transpose()?.into_iter().collect();
    let note =
        format!("{} seeds; an area of 25 m × 10 m, {N_LAPS} laps, empty map, raw odometry.", setup.n_seeds);
    Ok(ReportRun { metrics, figures, notes: vec![note], ..ReportRun::default() })
}

fn one(setup: &CmlExperimentSetup, seed: u64) -> Result<Lapped> {
    let building = RetailStore::draw(RetailStoreParams::area(), &mut Draw::World.rng(seed))?.building();
    let route = building.aisles().laps(N_LAPS, &mut Draw::Visit(0).rng(seed))?;
    let params = IndoorDriveParams { robot: robot(seed), ..IndoorDriveParams::default() };
    let trip = SimulatedDrive::drive(&building, route, params, Draw::Visit(0).streams(seed))?;
    let with = |params| localize_trip(&mut PanoramaLocalizer::new(params, known_start(&trip)?)?, &trip);
    let (course, published) = (with(setup.localizer)?, with(LocalizerParams::as_published())?);
    Ok(Lapped { building, trip, course, published })
}

fn of_lap(course: &SimulatedDriveResult, lap: usize) -> &[f64] {
    let n = course.errors.len();
    &course.errors[n * lap / N_LAPS..n * (lap + 1) / N_LAPS]
}

fn dead_reckoning_errors(trip: &SimulatedDrive) -> Vec<f64> {
    let reckoned = trip.dead_reckoning();
    trip.steps
        .iter()
        .zip(reckoned)
        .map(|(step, pose)| (step.pose.translation - pose.translation).norm())
        .collect()
}

fn path(lapped: &Lapped) -> MapPlot {
    MapPlot {
        title: format!("{N_LAPS} laps (first seed)"),
        ..plan(&lapped.building, &lapped.trip, &lapped.course)
    }
}

/// Paths of a drive between the shelves.
pub(super) fn plan(building: &Building, trip: &SimulatedDrive, course: &SimulatedDriveResult) -> MapPlot {
    let points = |poses: Vec<wayfix_estimation_traits::Pose2<f64>>| {
        poses.iter().map(|pose| (pose.x(), pose.y())).collect()
    };
    let walls = building.walls();
    MapPlot {
        truth: points(trip.steps.iter().map(|step| step.pose).collect()),
        estimate: course
            .estimates
            .iter()
            .map(|pose| pose.map_or((f64::NAN, f64::NAN), |pose| (pose.x(), pose.y())))
            .collect(),
        dead_reckoning: points(trip.dead_reckoning()),
        surroundings: walls
            .iter()
            .map(|wall| vec![(wall.from.x, wall.from.y), (wall.to.x, wall.to.y)])
            .collect(),
        ..MapPlot::default()
    }
}
