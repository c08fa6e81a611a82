//! One picture of the contour tracker: `cargo bench -p wayfix-visual-tracking --bench contour [--features parallel]`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. What is to be reached: 100 samples with contour and snake at 320 × 240 in 1.6e7 on two
//! cores.

#[path = "../tests/integration/common/films.rs"]
mod films;
#[path = "../../condensation/benches/support/harness.rs"]
mod harness;

use films::{mask_of, picture_of};
use harness::measure;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_visual_tracking::{ColorContourTracker, ColorContourTrackerParams, Tracker as _};

/// Pictures that are tracked before the one that is measured, so that colours and motion are known.
const N_BEFORE: usize = 10;

fn main() {
    for film in SyntheticFilm::ALL.into_iter().filter(|film| film.name != "head") {
        let mut frames = film.frames().expect("a known film");
        let first = frames.next().expect("frames");
        let params = ColorContourTrackerParams::default();
        let start = ColorContourTracker::from_mask(&picture_of(&first), &mask_of(&first.target), params);
        let mut tracker = start.expect("a target in sight");
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for frame in frames.by_ref().take(N_BEFORE) {
            tracker.track(&picture_of(&frame), &mut rng).expect("pictures of one size");
        }
        let next = picture_of(&frames.next().expect("frames"));
        measure(&format!("track contour, 100 samples, {}", film.name), 40, || {
            tracker.clone().track(&next, &mut rng)
        });
    }
}
