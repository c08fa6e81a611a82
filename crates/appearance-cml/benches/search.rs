//! Descriptors, comparisons, and searches among 1000 to 1 000 000 references: `cargo bench -p wayfix-appearance-cml`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`, and what each stage of a search let through. What is to be reached: a search among 100 000
//! references in less than 1e7, on one core.
//!
//! References are views of a simulated store of 240 m × 150 m along a tour, and blends of neighbouring ones where the tour is too short: a robot
//! that drives an aisle again and again sees it from places in between.

use std::hint::black_box;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_appearance_cml::{
    AppearanceIndex, LinearSearch, Panorama, PanoramaDescriptor, PanoramaDescriptorExtractor,
    PanoramaDescriptorParams, ReferenceId, ReferenceSearch, ViewDescriptor,
};
use wayfix_scene_sim::{
    indoors::{IndoorDrive, IndoorDriveParams, RetailStore, RetailStoreParams, calibrated_robot},
    random::RandomStreams,
};

const SEED: u64 = 3;
const TOUR_M: f64 = 2500.0;
const SIZES: [usize; 4] = [1000, 10_000, 100_000, 1_000_000];
/// As many neighbours as the localizer asks for, and the distance up to which views match in such a store.
const N_NEAREST: usize = 40;
const LIMIT: f64 = 0.64;
/// A distance that nearly all rough bounds are below: hard for a search, and more than the localizer asks for.
const WIDE: f64 = 0.87;

fn main() {
    let (learned, seen) = drives();
    let features = PanoramaDescriptorExtractor::new(PanoramaDescriptorParams::default(), 120, 20)
        .expect("the simulator's panoramas");
    let describe = |panorama: &Panorama| features.describe(panorama).expect("a view that shows something");
    let seconds = best_of(200, || describe(&seen[0]));
    report("describe 120 x 20", seconds);
    let learned: Vec<PanoramaDescriptor> = learned.iter().map(describe).collect();
    let seen: Vec<PanoramaDescriptor> = seen.iter().map(describe).collect();
    let seconds =
        best_of(20, || learned[..1000].iter().map(|view| seen[0].compare(view).distance).sum::<f64>());
    report("compare", seconds / 1000.0);

    for size in SIZES {
        let mut index = AppearanceIndex::default();
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        for id in 0..size {
            index.insert(ReferenceId(id as u32), reference(&learned, id)).expect("a new number");
        }
        report(&format!("insert, {size} references"), start.elapsed().as_secs_f64() / size as f64);
        let nearest = |view: &PanoramaDescriptor| index.nearest_counted(view, N_NEAREST, LIMIT);
        report(&format!("{N_NEAREST} nearest of {size}"), mean_of(&seen, |view| nearest(view).0.len()));
        let wide = |view: &PanoramaDescriptor| index.nearest_within(view, N_NEAREST, WIDE);
        report(
            &format!("{N_NEAREST} nearest of {size} up to {WIDE}"),
            mean_of(&seen, |view| wide(view).len()),
        );
        report(&format!("within 0.5 of {size}"), mean_of(&seen, |view| index.within(view, 0.5).len()));
        let costs: Vec<_> = seen.iter().map(|view| nearest(view).1).collect();
        let share = |count: fn(&wayfix_appearance_cml::SearchStatistics) -> usize| {
            let sum: usize = costs.iter().map(count).sum();
            100.0 * sum as f64 / (size * costs.len()) as f64
        };
        let (bounded, compared) = (share(|cost| cost.bounded), share(|cost| cost.compared));
        eprintln!(
            "{size}: rough bounds leave {bounded:.2} %, bounds {compared:.3} %, found {:.3} %",
            share(|cost| cost.found)
        );
        if size <= 10_000 {
            let mut linear = LinearSearch::default();
            for id in 0..size {
                linear.insert(ReferenceId(id as u32), reference(&learned, id)).expect("a new number");
            }
            let few = &seen[..seen.len() / 10];
            let seconds = mean_of(few, |view| linear.nearest_within(view, N_NEAREST, LIMIT).len());
            report(&format!("{N_NEAREST} nearest of {size}, linear scan"), seconds);
        }
    }
}

/// Views of a tour, and of another one through the same store.
fn drives() -> (Vec<Panorama>, Vec<Panorama>) {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let shape =
        RetailStoreParams { length_m: 240.0, width_m: 150.0, n_blocks: 9, ..RetailStoreParams::home_store() };
    let building = RetailStore::draw(shape, &mut rng).expect("a store").building();
    let mut drive = |metres: f64| -> Vec<Panorama> {
        let route = building.aisles().tour(metres, &mut rng).expect("aisles");
        let params = IndoorDriveParams {
            robot: calibrated_robot(&mut rng),
            n_people: 20,
            ..IndoorDriveParams::default()
        };
        let steps =
            IndoorDrive::new(&building, route, params, RandomStreams::new(rng.clone())).expect("a route");
        let size = |view: &Panorama| assert_eq!((view.n_columns(), view.n_rows()), (120, 20));
        steps
            .map(|step| Panorama::from_rgb(step.view.width, step.view.height, step.view.rgb))
            .map(|view| view.expect("pixels"))
            .inspect(size)
            .collect()
    };
    (drive(TOUR_M), drive(60.0))
}

/// A view of the tour, or a blend of two neighbouring ones, another one each time round.
fn reference(learned: &[PanoramaDescriptor], id: usize) -> PanoramaDescriptor {
    let (round, at) = (id / learned.len(), id % learned.len());
    let (a, b) = (&learned[at], &learned[(at + 1) % learned.len()]);
    // Multiples of the golden section spread evenly.
    let share = (round as f64 * 0.618_034).fract();
    a.blend(b, share).expect("views of one camera")
}

fn report(job: &str, seconds: f64) {
    println!("bench\t{job}\twayfix\t{:.0}", seconds * 1e9);
}

/// Seconds of one call: the best of `calls`.
fn best_of<O>(calls: usize, mut job: impl FnMut() -> O) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..calls {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        black_box(job());
        best = best.min(start.elapsed().as_secs_f64());
    }
    best
}

/// Seconds of one call, the mean over all views.
fn mean_of<O>(views: &[PanoramaDescriptor], mut job: impl FnMut(&PanoramaDescriptor) -> O) -> f64 {
    #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
    let start = std::time::Instant::now();
    for view in views {
        black_box(job(view));
    }
    start.elapsed().as_secs_f64() / views.len().max(1) as f64
}
