use anyhow::Result;
use wayfix_appearance_cml::{AppearanceMapParams, ForgettingMode, LocalizerParams};
use wayfix_evaluation::plot::{LinePlot, PlotSeries};
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::indoors::{AmbientLightParams, IndoorDriveParams, Laboratory};
use wayfix_systems::cml::PanoramaLocalizer;

use super::localize_trip::known_start;
use super::summary::{mean, mean_of, over_seeds};
use super::worlds::{Draw, robot, tour};
use super::{CmlExperimentSetup, SimulatedDriveResult, localize_trip};

/// Mean time between two changes of lamps or curtains, seconds.
const SWITCHING_S: f64 = 30.0;
/// Steps after which references are counted. [Gross et al. 2005, Table 1]
const STEPS: [usize; 4] = [2000, 4000, 6000, 8000];

/// The drives of [`one`], as the figures call them.
const COURSES: [&str; 4] = ["passive", "active", "passive_as_published", "active_as_published"];

/// References in a lab with changing lamps and curtains, with and without active forgetting. [Gross et al. 2005, Table 1]
/// # Errors
/// Returns an error if a drive cannot be simulated or followed, or the picture not be drawn.
pub(crate) fn changing_lab(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let seeds = over_seeds("changing_lab", setup, seed, |seed| one(setup, seed))?;
    let mut metrics: Vec<Metric> = Vec::new();
    for (at, name) in COURSES.iter().enumerate() {
        for step in STEPS {
            if seeds.iter().all(|courses| courses[at].n_references.len() >= step) {
                let count = |courses: &[SimulatedDriveResult; 4]| courses[at].n_references[step - 1] as f64;
                metrics.extend(mean_of(&format!("n_references_{name}_{step}"), "", &seeds, count));
            }
        }
        metrics.extend(growth(name, &seeds, at));
        metrics.extend(mean_of(&format!("error_mean_m_{name}"), "m", &seeds, |courses| {
            mean(&courses[at].errors)
        }));
    }
    let points = |course: &SimulatedDriveResult| {
        course.n_references.iter().enumerate().step_by(20).map(|(step, n)| (step as f64, *n as f64)).collect()
    };
    let series = seeds.first().map_or(Vec::new(), |[passive, active, ..]| {
        vec![
            PlotSeries::new("passive forgetting", points(passive)),
            PlotSeries::new("active forgetting", points(active)),
        ]
    });
    let plot = LinePlot {
        title: "References in a lab whose light changes (first seed)".to_owned(),
        x_label: "step".to_owned(),
        y_label: "references".to_owned(),
        series,
        ..LinePlot::default()
    };
    let note = format!(
        "{} seeds; lamps are switched or a curtain is drawn every {SWITCHING_S} s in the mean; empty map, raw odometry.",
        setup.n_seeds
    );
    Ok(ReportRun { metrics, figures: vec![plot.draw()?], notes: vec![note], ..ReportRun::default() })
}

/// Growth of the number of references in the last quarter of the steps, as a share of it.
fn growth(name: &str, seeds: &[[SimulatedDriveResult; 4]], at: usize) -> Vec<Metric> {
    let share = |courses: &[SimulatedDriveResult; 4]| {
        let counts = &courses[at].n_references;
        let at = |quarter: usize| {
            counts.get((counts.len() * quarter / 4).saturating_sub(1)).map_or(f64::NAN, |n| *n as f64)
        };
        at(4) / at(3) - 1.0
    };
    mean_of(&format!("n_references_growth_last_quarter_{name}"), "", seeds, share)
}

/// The same drive with passive and with active forgetting, then both as published.
fn one(setup: &CmlExperimentSetup, seed: u64) -> Result<[SimulatedDriveResult; 4]> {
    let building = Laboratory::draw(&mut Draw::World.rng(seed)).building();
    let ambient_light =
        AmbientLightParams { mean_lamp_switching_s: Some(SWITCHING_S), ..AmbientLightParams::default() };
    let params =
        IndoorDriveParams { robot: robot(seed), ambient_light, n_people: 1, ..IndoorDriveParams::default() };
    let mut trip = tour(&building, setup.length_m, params, (seed, 0))?;
    trip.steps.truncate(STEPS[STEPS.len() - 1]);
    let with = |params: LocalizerParams, forgetting_mode| {
        let params = LocalizerParams { map: AppearanceMapParams { forgetting_mode, ..params.map }, ..params };
        localize_trip(&mut PanoramaLocalizer::new(params, known_start(&trip)?)?, &trip)
    };
    let (ours, published) = (setup.localizer, LocalizerParams::as_published());
    Ok([
        with(ours, ForgettingMode::Passive)?,
        with(ours, ForgettingMode::Active)?,
        with(published, ForgettingMode::Passive)?,
        with(published, ForgettingMode::Active)?,
    ])
}
