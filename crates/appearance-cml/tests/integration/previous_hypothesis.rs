//! A robot that is localized in the wrong one of two similar aisles, and the recovery with the previous hypothesis.

use crate::common::{Field, FieldView, beside, between, drifting, known};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_appearance_cml::{
    AppearanceLocalizer, LocalizerEvent, LocalizerParams, RelocalizationParams, StartPosePrior,
};
use wayfix_estimation_traits::{LieGroup, Pose2};

const N_SEEDS: u64 = 10;
/// Steps of 0.26 m on average: known ground, unknown ground, an aisle that looks like another one, unknown ground, known ground.
const KNOWN: usize = 20;
const STRANGE: usize = KNOWN + 12;
const ALIKE: usize = STRANGE + 60;
const GAP: usize = ALIKE + 30;
const END: usize = GAP + 25;

/// Pose of the robot, 100 m from the aisle that looks the same.
fn far(step: usize) -> Pose2<f64> {
    Pose2::new(100.0, 0.0, 0.0).compose(&beside(step, 0.0))
}

/// Result of a drive.
struct Drive {
    /// Whether the estimate was in the other aisle.
    was_elsewhere: bool,
    /// Error at the end, m.
    error: f64,
    /// References that were learned with the wrong estimate.
    n_learned_astray: usize,
}

fn drive(seed: u64, kept_distance: f64) -> Drive {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let [aisle, here, strange, gap] = std::array::from_fn(|_| Field::new(&mut rng));
    let params = LocalizerParams {
        relocalization: RelocalizationParams {
            alternative_kept_distance: kept_distance,
            ..RelocalizationParams::default()
        },
        ..LocalizerParams::default()
    };
    let mut localizer =
        AppearanceLocalizer::<FieldView>::new(params, StartPosePrior::Known(known(far(0)))).expect("valid");
    for step in 0..=ALIKE {
        localizer
            .teach(aisle.view(&beside(step, 0.0), &mut rng), &known(beside(step, 0.0)))
            .expect("a good view");
    }
    for step in (0..=KNOWN).chain(GAP..=END) {
        localizer.teach(here.view(&far(step), &mut rng), &known(far(step))).expect("a good view");
    }
    let mut drive = Drive { was_elsewhere: false, error: f64::INFINITY, n_learned_astray: 0 };
    for step in 0..END {
        let view = match step {
            ..KNOWN => here.view(&far(step), &mut rng),
            KNOWN..STRANGE => strange.view(&far(step), &mut rng),
            STRANGE..ALIKE => aisle.view(&beside(step, 0.0), &mut rng),
            ALIKE..GAP => gap.view(&far(step), &mut rng),
            _ => here.view(&far(step), &mut rng),
        };
        let outcome = localizer.update(view).expect("a good view");
        let is_away = localizer.estimate().is_some_and(|estimate| estimate.mean().x() < 50.0);
        drive.was_elsewhere |= is_away;
        let made = outcome.events.iter().filter(|event| matches!(event, LocalizerEvent::NewReference(_)));
        drive.n_learned_astray += if is_away { made.count() } else { 0 };
        localizer.predict(&drifting(&between(&far(step), &far(step + 1)), &mut rng)).expect("finite");
    }
    let off = |pose: &Pose2<f64>| (pose.translation - far(END).translation).norm();
    drive.error = localizer.estimate().map_or(f64::INFINITY, |estimate| off(estimate.mean()));
    drive
}

#[test]
fn robot_in_a_similar_aisle_learns_nothing_and_returns() {
    let drives =
        |kept_distance: f64| -> Vec<Drive> { (0..N_SEEDS).map(|seed| drive(seed, kept_distance)).collect() };
    let astray = |drives: &[Drive]| -> usize { drives.iter().map(|drive| drive.n_learned_astray).sum() };
    let (kept, forgotten) = (drives(RelocalizationParams::default().alternative_kept_distance), drives(0.0));
    // It learns again after the previous hypothesis has been kept for its distance.
    assert!(astray(&drives(3.0)) > 0, "the other aisle goes on for 15 m");
    assert!(kept.iter().all(|drive| drive.was_elsewhere), "an aisle that looks the same for 15 m");
    assert_eq!(astray(&kept), 0);
    assert!(astray(&forgotten) > 0, "without a previous hypothesis the robot learns at once");
    for (seed, drive) in kept.iter().enumerate() {
        // Odometry errs by 1 % of 30 m along, and by 0.002 · 30² / 2 = 0.9 m across; what is seen at the end corrects it.
        assert!(drive.error < 1.0, "seed {seed}: {} m", drive.error);
    }
}
