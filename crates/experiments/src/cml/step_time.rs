use std::hint::black_box;

use anyhow::Result;
use wayfix_appearance_cml::{LocalizerParams, MapLearning, PanoramaDescriptor, StartPosePrior};
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::plot::{AxisScale, LinePlot, PlotSeries, statistics::quantile};
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::indoors::{IndoorDriveParams, RetailStore, RetailStoreParams};
use wayfix_system_core::Stopwatch;
use wayfix_systems::cml::{PanoramaLocalizer, PanoramaMap};

use super::localize_trip::{known_start, surveyed, taught};
use super::worlds::{Draw, robot, tour};
use super::{CmlExperimentSetup, SimulatedDrive, SimulatedDriveStep, localize_trip};

/// Numbers of references.
const N_REFERENCES: [usize; 7] = [1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000];
/// Steps that are timed in each map.
const N_STEPS: usize = 200;
/// Quantile of the step times reported for a kidnapped robot, whose steps vary.
const KIDNAPPED_QUANTILE: f64 = 0.95;

/// Computing time over the number of references: of a step of a localized robot, of a step of a kidnapped robot with two hypotheses, and of a search
/// of the whole map for global localization. Times vary from call to call, and other runs of a report run in parallel.
/// # Errors
/// Returns an error if a drive cannot be simulated or followed, or the picture not be drawn.
pub(crate) fn step_time(setup: &CmlExperimentSetup, seed: u64) -> Result<ReportRun> {
    let seed = setup.seeds(seed).start;
    let shape =
        RetailStoreParams { length_m: 240.0, width_m: 150.0, n_blocks: 9, ..RetailStoreParams::home_store() };
    let building = RetailStore::draw(shape, &mut Draw::World.rng(seed))?.building();
    let params = IndoorDriveParams { robot: robot(seed), n_people: 20, ..IndoorDriveParams::default() };
    let learned = tour(&building, setup.length_m, params, (seed, 0))?;
    let mut again = tour(&building, 0.25 * N_STEPS as f64, params, (seed, 1))?;
    again.steps.truncate(N_STEPS);

    // The smallest number of references suffices to learn the match threshold.
    let first = learned.steps.len().min(N_REFERENCES[0]);
    let mut map = taught(&SimulatedDrive { steps: learned.steps[..first].to_vec() })?;
    let mut more = between(&learned).skip(first);
    // Halfway along the part that every map contains, away from the drive.
    let elsewhere = StartPosePrior::Known(surveyed(learned.steps[first / 2].pose)?);
    let astray = LocalizerParams { map_learning: MapLearning::Static, ..setup.localizer };
    let (mut steps, mut doubts, mut searches) = (Vec::new(), Vec::new(), Vec::new());
    let median_ms = |seconds| quantile_ms(seconds, 0.5);
    for n in N_REFERENCES {
        while map.len() < n
            && let Some((view, pose)) = more.next()
        {
            map.teach(view, &surveyed(pose)?)?;
        }
        let n = map.len() as f64;
        searches.push((n, median_ms(search_s(&map, &again, &setup.localizer))));
        for (start, params, share, times) in [
            (elsewhere.clone(), astray, KIDNAPPED_QUANTILE, &mut doubts),
            (known_start(&again)?, setup.localizer, 0.5, &mut steps),
        ] {
            let mut localizer = PanoramaLocalizer::with_map(params, map, start)?;
            times.push((n, quantile_ms(localize_trip(&mut localizer, &again)?.step_s, share)));
            map = localizer.into_map();
        }
    }
    let plot = LinePlot {
        title: "Computing time of a step".to_owned(),
        x_label: "references".to_owned(),
        y_label: "ms".to_owned(),
        series: vec![
            PlotSeries::new(format!("localized robot: median of {N_STEPS} steps"), steps.clone()),
            PlotSeries::new("kidnapped robot: 95 % of the steps", doubts.clone()),
            PlotSeries::new("global localization: a search of the whole map", searches.clone()),
        ],
        x_scale: AxisScale::Log10,
        y_scale: AxisScale::Log10,
        ..LinePlot::default()
    };
    let of = |(what, times): (&str, &[(f64, f64)])| {
        let named =
            |(n, (_, ms)): (&usize, &(f64, f64))| Metric::new(format!("{what}_ms_{n}_references"), *ms, "ms");
        N_REFERENCES.iter().zip(times).map(named).collect::<Vec<_>>()
    };
    let timings = [
        ("step_time_median", &steps[..]),
        ("kidnapped_step_time_p95", &doubts),
        ("global_search_time_median", &searches),
    ]
    .map(of)
    .concat();
    Ok(ReportRun { timings, figures: vec![plot.draw()?], ..ReportRun::default() })
}

/// The views of a trip, and then, round by round, views between successive ones.
fn between(trip: &SimulatedDrive) -> impl Iterator<Item = (PanoramaDescriptor, Pose2<f64>)> {
    // Each round adds at least one reference, or it never ends.
    (0..N_REFERENCES[6] as u32).flat_map(|round| {
        // Multiples of the golden section spread evenly; the first round is of the views themselves.
        let share = (f64::from(round) * 0.618_034).fract();
        let view = move |pair: &[SimulatedDriveStep]| {
            let view = pair[0].view.as_ref()?.blend(pair[1].view.as_ref()?, share)?;
            Some((view, pair[0].pose))
        };
        trip.steps.windows(2).filter_map(view)
    })
}

/// Seconds of searches without a prior belief.
fn search_s(map: &PanoramaMap, trip: &SimulatedDrive, params: &LocalizerParams) -> Vec<f64> {
    let views = trip.steps.iter().filter_map(|step| step.view.as_ref());
    let search = |view: &PanoramaDescriptor| {
        let stopwatch = Stopwatch::start();
        black_box(map.place_matches(
            view,
            &[],
            params.mixture_reduction.max_components,
            (&params.map, params.fusion.gate),
        ));
        stopwatch.elapsed().as_secs_f64()
    };
    views.map(search).collect()
}

fn quantile_ms(seconds: Vec<f64>, share: f64) -> f64 {
    quantile(seconds, share).map_or(f64::NAN, |seconds| 1e3 * seconds)
}
