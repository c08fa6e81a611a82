use anyhow::Result;
use wayfix_appearance_cml::LocalizerParams;
use wayfix_evaluation::plot::MapPlot;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::indoors::{Building, IndoorDriveParams, RetailStore, RetailStoreParams};
use wayfix_systems::cml::histogram;
use wayfix_systems::cml::{PanoramaLocalizer, PanoramaMap};

use super::area::plan;
use super::localize_trip::known_start;
use super::summary::{by_seed, largest, mean, mean_of, over_seeds, ratio_of};
use super::worlds::{Draw, robot, tour};
use super::{CmlExperimentSetup, SimulatedDrive, SimulatedDriveResult, localize_trip};

const N_DAYS: usize = 3;
/// Share of the shelf sections that are rearranged over night.
const REARRANGED: f64 = 0.05;
const N_PEOPLE: usize = 8;
/// "A relatively large local area" of the store.
const SIZE_M: [f64; 2] = [40.0, 25.0];

struct Day {
    building: Building,
    trip: SimulatedDrive,
    course: SimulatedDriveResult,
    /// The same with the method as published.
    published: SimulatedDriveResult,
}

/// Three days from an empty map, raw odometry; each day begins where the robot is charged. [Gross et al. 2005, Fig. 6]
///
/// # Errors
/// Returns an error if a drive cannot be simulated or followed, or the picture not be drawn.
pub(crate) fn three_days(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let seeds = over_seeds("three_days", setup, seed, |seed| one(setup, seed))?;
    let mut metrics: Vec<Metric> = Vec::new();
    for day in 0..N_DAYS {
        let number = day + 1;
        metrics.extend(mean_of(&format!("error_mean_m_day{number}"), "m", &seeds, |days| {
            mean(&days[day].course.errors)
        }));
        metrics.extend(mean_of(&format!("error_max_m_day{number}"), "m", &seeds, |days| {
            largest(&days[day].course.errors)
        }));
        metrics.extend(mean_of(&format!("error_mean_m_day{number}_as_published"), "m", &seeds, |days| {
            mean(&days[day].published.errors)
        }));
        let references = |days: &Vec<Day>| days[day].course.n_references.last().map_or(0.0, |n| *n as f64);
        metrics.extend(mean_of(&format!("n_references_day{number}"), "", &seeds, references));
    }
    let error = |day: usize| move |days: &Vec<Day>| mean(&days[day].course.errors);
    metrics.extend(ratio_of("error_mean_ratio_day2_over_day1", &seeds, error(1), error(0)));
    metrics.extend(ratio_of("error_mean_ratio_day3_over_day2", &seeds, error(2), error(1)));
    let errors = |day: usize| seeds.iter().flat_map(|days| days[day].course.errors.clone()).collect();
    let days = (0..N_DAYS).map(|day| (format!("day {}", day + 1), errors(day))).collect();
    let mut figures = vec![histogram("Errors of three days", 2.0, days).draw()?];
    if let Some(last) = seeds.first().and_then(|days| days.last()) {
        let title = format!("Day {N_DAYS} (first seed)");
        figures.push(MapPlot { title, ..plan(&last.building, &last.trip, &last.course) }.draw()?);
    }
    let note = format!(
        "{} seeds; {} m × {} m of a store, {} m a day, {:.0} % of the shelf sections rearranged every night, {N_PEOPLE} people.",
        setup.n_seeds,
        SIZE_M[0],
        SIZE_M[1],
        setup.length_m,
        100.0 * REARRANGED
    );
    let each = |day: usize| {
        by_seed(&format!("Day {}", day + 1), seeds.iter().map(|days| &days[day].course.errors[..]))
    };
    let notes = std::iter::once(note).chain((0..N_DAYS).map(each)).collect();
    Ok(ReportRun { metrics, figures, notes, ..ReportRun::default() })
}

fn one(setup: &CmlExperimentSetup, seed: u64) -> Result<Vec<Day>> {
    let shape = RetailStoreParams {
        length_m: SIZE_M[0],
        width_m: SIZE_M[1],
        n_blocks: 2,
        n_departments: 5,
        ..RetailStoreParams::home_store()
    };
    let mut store = RetailStore::draw(shape, &mut Draw::World.rng(seed))?;
    let params = IndoorDriveParams { robot: robot(seed), n_people: N_PEOPLE, ..IndoorDriveParams::default() };
    let mut localizers =
        [setup.localizer, LocalizerParams::as_published()].map(|params| (params, PanoramaMap::default()));
    let mut days = Vec::new();
    for day in 0..N_DAYS as u64 {
        if day > 0 {
            store = store.rearranged(REARRANGED, &mut Draw::Rearranged(day).rng(seed))?;
        }
        let building = store.building();
        let trip = tour(&building, setup.length_m, params, (seed, day))?;
        let mut courses = Vec::new();
        for (params, map) in &mut localizers {
            let mut today = PanoramaLocalizer::with_map(*params, std::mem::take(map), known_start(&trip)?)?;
            courses.push(localize_trip(&mut today, &trip)?);
            *map = today.into_map();
        }
        let (published, course) = (courses.pop().unwrap_or_default(), courses.pop().unwrap_or_default());
        days.push(Day { building, trip, course, published });
    }
    Ok(days)
}
