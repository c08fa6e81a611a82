//! A robot beside the lane, that recognizes no place: which way it looks it sees all the same.

mod common;

use common::{Field, FieldView, N_STEPS, beside, between, known};
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_appearance_cml::{AppearanceLocalizer, AppearanceMapParams, Learning, LocalizerParams, Start};
use wayfix_estimation_traits::{LieGroup, Pose2, wrap_angle};
use wayfix_gaussian_core::Gaussian;

type Localizer = AppearanceLocalizer<FieldView>;

const N_SEEDS: u64 = 10;
/// Steps of 25 m, more than half of a lap.
const TRAVEL: usize = 96;
/// Beside the lane that was taught, m: too far to be recognized.
const BESIDE: f64 = 0.9;
/// By how much the start is turned, rad.
const TURNED: f64 = 0.15;
/// How well it is said to be known, rad.
const SIGMA: f64 = 0.2;

/// By how much the heading is off after 25 m, rad, and how often a place was recognized on the way.
fn heading_error(seed: u64, params: LocalizerParams) -> (f64, usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let field = Field::new(&mut rng);
    let mut teacher = Localizer::new(params, Start::Anywhere).expect("valid defaults");
    for step in 0..N_STEPS {
        let pose = beside(step, 0.0);
        teacher.teach(field.view(&pose, &mut rng), &known(pose)).expect("a good view");
    }
    let first = beside(0, BESIDE).compose(&Pose2::new(0.0, 0.0, TURNED));
    let start = Gaussian::from_sigmas(first, &Vector3::new(0.02, 0.02, SIGMA)).expect("sigmas are positive");
    let mut localizer =
        Localizer::with_map(params, teacher.into_map(), Start::Known(start)).expect("valid defaults");
    let mut n_sightings = 0;
    for step in 0..TRAVEL {
        let pose = beside(step, BESIDE);
        let outcome = localizer.update(field.view(&pose, &mut rng)).expect("a good view");
        n_sightings += outcome.n_sightings;
        let moved = between(&pose, &beside(step + 1, BESIDE));
        localizer.predict(&moved).expect("finite odometry");
    }
    let heading = localizer.estimate().map_or(f64::INFINITY, |estimate| estimate.mean().heading());
    (wrap_angle(heading - beside(TRAVEL, BESIDE).heading()).abs(), n_sightings)
}

#[test]
fn who_recognizes_no_place_is_turned_the_right_way_all_the_same() {
    // Nothing matches, so that odometry alone would keep the heading as wrong as it was.
    let map = AppearanceMapParams { match_limit: Some(1e-3), ..AppearanceMapParams::default() };
    let params = LocalizerParams { learning: Learning::Static, map, ..LocalizerParams::default() };
    let errors: Vec<f64> = (0..N_SEEDS)
        .map(|seed| {
            let (error, n_sightings) = heading_error(seed, params);
            assert_eq!(n_sightings, 0, "seed {seed}");
            error
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / N_SEEDS as f64;
    // A reading has σ = 0.56 rad at most, twice 0.03 + 0.25. When one view of three gives one, 32 of them make 102 of 1/σ² beside the 25 of the start, and
    // leave a fifth of its error; half of it is allowed.
    assert!(mean < 0.5 * TURNED, "{mean} rad: {errors:?}");
}
