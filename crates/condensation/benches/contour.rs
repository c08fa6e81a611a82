//! One picture of the contour tracker: `cargo bench -p wayfix-condensation --bench contour [--features parallel]`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. What is to be reached: 100 samples with contour and snake at 320 × 240 in 1.6e7 on two
//! cores.

use std::hint::black_box;

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{BitMask, ContourTracker, ContourTrackerParams, Picture, Tracker as _};
use wayfix_scene_sim::film::{Film, Frame};

/// Pictures of each film that are tracked, after the first.
const N_FRAMES: usize = 40;

fn main() {
    for name in ["circles", "snail"] {
        let film = Film { seed: 1, n_frames: N_FRAMES + 1, ..Film::named(name).expect("a known film") };
        let frames: Vec<Frame> = film.frames().expect("a known film").collect();
        let pictures: Vec<Picture> = frames.iter().map(picture).collect();
        let target = &frames[0].target;
        let inside = |u: usize, v: usize| target.pixels()[v * target.width() + u];
        let mask = BitMask::from_fn(target.width(), target.height(), inside).expect("pixels");
        let params = ContourTrackerParams::default();
        let start = ContourTracker::from_mask(&pictures[0], &mask, params).expect("a target in sight");
        let seconds = best_of(5, || {
            let (mut tracker, mut rng) = (start.clone(), ChaCha8Rng::seed_from_u64(1));
            for picture in &pictures[1..] {
                black_box(tracker.track(picture, &mut rng).expect("pictures of one size"));
            }
        });
        println!(
            "bench\tcontour, 100 samples, 320 × 240, {name}\twayfix\t{:.0}",
            seconds * 1e9 / N_FRAMES as f64
        );
    }
}

fn picture(frame: &Frame) -> Picture {
    let rgb = &frame.picture;
    Picture::from_rgb(rgb.width, rgb.height, rgb.rgb.clone()).expect("three bytes a pixel")
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
