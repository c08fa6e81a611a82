//! A part of the way looks different from what was taught.

mod common;

use std::ops::Range;

use common::{Field, FieldView, N_STEPS, beside, between, drifting, known};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_appearance_cml::{AppearanceLocalizer, AppearanceMap, Learning, LocalizerParams, Start};

type Localizer = AppearanceLocalizer<FieldView>;

/// Steps of the way that were rearranged: 16 m.
const REARRANGED: Range<usize> = 40..100;

/// Where nothing is recognized on the way there.
const INSIDE: Range<usize> = 50..90;

/// Drives once round, and gives the mean error where the way was rearranged.
fn lap(localizer: &mut Localizer, fields: [&Field; 2], rng: &mut ChaCha8Rng) -> f64 {
    let mut errors = Vec::new();
    for k in 0..N_STEPS {
        let (pose, next) = (beside(k, 0.0), beside(k + 1, 0.0));
        let field = fields[usize::from(REARRANGED.contains(&k))];
        localizer.update(field.view(&pose, rng)).expect("a good view");
        if INSIDE.contains(&k) {
            let at = localizer.estimate().expect("the start is known").mean();
            errors.push((at.translation - pose.translation).norm());
        }
        localizer.predict(&drifting(&between(&pose, &next), rng)).expect("finite odometry");
    }
    errors.iter().sum::<f64>() / errors.len() as f64
}

/// What the second lap errs by with what the first has learned.
fn second_lap(seed: u64, patience: usize, memory: usize) -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (before, after) = (Field::new(&mut rng), Field::new(&mut rng));
    let mut teacher = Localizer::new(LocalizerParams::default(), Start::Anywhere).expect("valid defaults");
    for k in 0..N_STEPS {
        teacher.teach(before.view(&beside(k, 0.0), &mut rng), &known(beside(k, 0.0))).expect("a good view");
    }
    let mut drive = |map: AppearanceMap<FieldView>, learning| {
        let params = LocalizerParams { learning, patience, memory, ..LocalizerParams::default() };
        let start = Start::Known(known(beside(0, 0.0)));
        let mut localizer = Localizer::with_map(params, map, start).expect("valid parameters");
        let error = lap(&mut localizer, [&before, &after], &mut rng);
        (localizer.into_map(), error)
    };
    let (map, _) = drive(teacher.into_map(), Learning::Adapting);
    drive(map, Learning::Static).1
}

#[test]
fn references_of_a_rearranged_aisle_are_corrected_at_its_end() {
    let of = |patience, memory| (0..10).map(|seed| second_lap(seed, patience, memory)).sum::<f64>() / 10.0;
    let LocalizerParams { patience, memory, .. } = LocalizerParams::default();
    let (waiting, spread, at_once) = (of(patience, 0), of(0, memory), of(0, 0));
    // A random walk of length 1 has a mean variance of 1/2, one that is tied down at both ends of 1/6: 0.58 in σ. Half way from there to no gain.
    assert!(waiting < 0.79 * at_once, "{waiting} m, {at_once} m without waiting");
    assert!(spread < 0.79 * at_once, "{spread} m, {at_once} m where nothing is spread back");
}
