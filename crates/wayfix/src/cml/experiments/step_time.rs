use std::hint::black_box;

use anyhow::Result;
use wayfix_appearance_cml::{LocalizerParams, PanoramaDescriptor};
use wayfix_scene_sim::indoors::{IndoorParams, Store, StoreParams};

use super::follow::{known_start, surveyed, taught};
use super::worlds::{Draw, robot, tour};
use super::{Setup, Trip, follow};
use crate::cml::PanoramaLocalizer;
use crate::plot::{LinesPlot, Scale, Series, statistics::median};
use crate::report::{Metric, Run};
use crate::system::Stopwatch;

/// Numbers of references in maps that a robot drives through.
const N_DRIVEN: [usize; 5] = [1000, 3000, 10_000, 30_000, 100_000];
/// And of those that it is looked for in.
const N_SEARCHED: [usize; 7] = [1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000];
/// Steps that are timed in each map.
const N_STEPS: usize = 200;

/// Computing time against the number of references: of a step of a robot that knows where it is, and of the search in the whole map that is added where it does not.
/// Times change from call to call, and other runs of a report go on beside this one.
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

    let mut steps = Vec::new();
    for n in N_DRIVEN.into_iter().filter(|n| *n <= learned.steps.len()) {
        let part = Trip { steps: learned.steps[..n].to_vec() };
        let mut localizer =
            PanoramaLocalizer::with_map(setup.localizer, taught(&part)?, known_start(&again)?)?;
        steps.push((n as f64, median_ms(follow(&mut localizer, &again)?.step_s)));
    }
    let searches = search_times(&learned, &again, &setup.localizer)?;

    let timings = |name: &'static str, points: &[(f64, f64)]| {
        points
            .iter()
            .map(|(n, ms)| Metric::new(format!("{name}_median_ms_{n}"), *ms, "ms"))
            .collect::<Vec<_>>()
    };
    let timings = [timings("step", &steps), timings("search", &searches)].concat();
    let plot = LinesPlot {
        title: "Computing time of a step".to_owned(),
        x_label: "references".to_owned(),
        y_label: "ms".to_owned(),
        series: vec![
            Series::new(format!("who knows where it is: median of {N_STEPS} steps"), steps),
            Series::new("who does not: the search of the whole map", searches),
        ],
        x_scale: Scale::Log10,
        y_scale: Scale::Log10,
        ..LinesPlot::default()
    };
    Ok(Run { timings, figures: vec![plot.draw()?], ..Run::default() })
}

/// Medians of searches without a belief in maps that grow: of the views learned, and, where these are too few, of blends of successive ones.
fn search_times(learned: &Trip, seen: &Trip, params: &LocalizerParams) -> Result<Vec<(f64, f64)>> {
    // What the limit of a match is learned from needs no more than this.
    let first = learned.steps.len().min(N_SEARCHED[0]);
    let mut map = taught(&Trip { steps: learned.steps[..first].to_vec() })?;
    let limit = map.match_limit(&params.map);
    let mut rounds =
        (0..).flat_map(|round| learned.steps.windows(2).map(move |pair| (round, pair))).skip(first);
    let mut points = Vec::new();
    for n in N_SEARCHED {
        while map.len() < n
            && let Some((round, [a, b])) = rounds.next()
        {
            let (Some(view), Some(next)) = (&a.view, &b.view) else { continue };
            // Multiples of the golden section spread evenly; the first round is of the views themselves.
            let share = (f64::from(round) * 0.618_034).fract();
            if let Some(between) = view.blend(next, share) {
                map.teach(between, &surveyed(a.pose)?)?;
            }
        }
        let search = |view: &PanoramaDescriptor| {
            let stopwatch = Stopwatch::start();
            black_box(map.sightings_anywhere(view, &[], params.most_matches, limit));
            stopwatch.elapsed().as_secs_f64()
        };
        let views = seen.steps.iter().filter_map(|step| step.view.as_ref());
        points.push((map.len() as f64, median_ms(views.map(search))));
    }
    Ok(points)
}

fn median_ms(seconds: impl IntoIterator<Item = f64>) -> f64 {
    median(seconds).map_or(f64::NAN, |median| 1e3 * median)
}
