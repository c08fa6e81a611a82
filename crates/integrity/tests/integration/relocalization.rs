//! A robot in a corridor of cells that is moved, and one that is not.
#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::assert_abs_diff_eq;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use wayfix_integrity::{IntegrityError, RelocalizationCandidate, RelocalizationParams, RelocalizationTest};

const SEED: u64 = 43;
const N_CELLS: usize = 20;

/// The measurement of each cell; its noise has variance 1.
fn map(rng: &mut ChaCha8Rng) -> Vec<f64> {
    (0..N_CELLS).map(|_| rng.random_range(-2.0..2.0)).collect()
}

/// Drives on the spot, 1 m a step, and searches all cells at each step. Returns the steps at which the hypothesis was replaced.
fn drive(
    params: RelocalizationParams,
    map: &[f64],
    n_steps: usize,
    truth: impl Fn(usize) -> usize,
    rng: &mut ChaCha8Rng,
) -> (Vec<usize>, usize) {
    let normal = Normal::new(0.0, 1.0).unwrap();
    let mut relocalization = RelocalizationTest::new(params).unwrap();
    let (mut present, mut replaced) = (truth(0), Vec::new());
    for step in 0..n_steps {
        let measured = map[truth(step)] + normal.sample(rng);
        let log_likelihood = |cell: usize| -0.5 * (measured - map[cell]).powi(2);
        relocalization.drive(1.0).unwrap();
        let at_present = log_likelihood(present);
        relocalization.observe(at_present, |cell| log_likelihood(*cell)).unwrap();
        let proposal = |cell: usize| RelocalizationCandidate {
            hypothesis: cell,
            prior: 1.0 / N_CELLS as f64,
            log_likelihood_ratio: log_likelihood(cell) - at_present,
        };
        let is_new = |cell: &usize| {
            *cell != present && relocalization.alternatives().iter().all(|a| a.hypothesis != *cell)
        };
        let proposals: Vec<_> = (0..N_CELLS).filter(is_new).map(proposal).collect();
        relocalization.propose(proposals).unwrap();
        if relocalization.decide(&mut present) {
            replaced.push(step);
        }
    }
    (replaced, present)
}

#[test]
fn false_alarms_are_as_rare_as_asked() {
    // The expected statistic of a robot that is not moved is at most the distance. By Markov's inequality at the first alarm, the probability
    // of an alarm within d is at most d / A.
    const N_RUNS: usize = 500;
    const N_METERS: usize = 200;
    let params =
        RelocalizationParams { false_alarms_per_km: 1.0, kidnappings_per_km: 10.0, ..Default::default() };
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let n_runs_with_alarm = (0..N_RUNS)
        .filter(|_| {
            let map = map(&mut rng);
            !drive(params, &map, N_METERS, |_| 3, &mut rng).0.is_empty()
        })
        .count();
    let share = N_METERS as f64 / 1000.0;
    let deviation = (share * (1.0 - share) / N_RUNS as f64).sqrt();
    let measured = n_runs_with_alarm as f64 / N_RUNS as f64;
    assert!(measured < share + 2.0 * deviation, "{measured} of {N_RUNS} runs, bound {share}");
}

#[test]
fn moved_robot_is_found() {
    let params = RelocalizationParams::default();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED + 1);
    let n_found = (0..100)
        .filter(|_| {
            let map = map(&mut rng);
            let (_, present) = drive(params, &map, 3000, |step| if step < 500 { 3 } else { 11 }, &mut rng);
            // Cells that look alike are alike.
            (map[present] - map[11]).abs() < 0.2
        })
        .count();
    assert!(n_found >= 95, "{n_found} of 100");
}

#[test]
fn previous_hypothesis_returns_within_its_distance() {
    let params = RelocalizationParams { alternative_kept_distance: 20.0, ..Default::default() };
    for (distance, is_kept) in [(19.0, true), (21.0, false)] {
        let mut present = "here";
        let mut relocalization = RelocalizationTest::new(params).unwrap();
        relocalization
            .propose([RelocalizationCandidate { hypothesis: "there", prior: 0.5, log_likelihood_ratio: 0.0 }])
            .unwrap();
        relocalization.observe(0.0, |_| 20.0).unwrap();
        assert!(relocalization.decide(&mut present));
        assert!(relocalization.alternatives()[0].is_previous());
        relocalization.drive(distance).unwrap();
        relocalization.observe(-100.0, |_| 0.0).unwrap();
        assert_eq!(relocalization.decide(&mut present), is_kept);
        assert_eq!(present, if is_kept { "here" } else { "there" });
    }
}

#[test]
fn odds_are_inverted_when_hypotheses_change_places() {
    let mut present = 0;
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    relocalization
        .propose([RelocalizationCandidate { hypothesis: 1, prior: 0.5, log_likelihood_ratio: 0.0 }])
        .unwrap();
    relocalization.observe(0.0, |_| 15.0).unwrap();
    let moved = relocalization.probability();
    assert!(relocalization.decide(&mut present));
    assert_abs_diff_eq!(relocalization.probability(), 1.0 - moved, epsilon = 1e-12);
}

#[test]
fn equal_alternatives_do_not_take_turns() {
    let mut present = 0;
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    let proposal = |hypothesis| RelocalizationCandidate { hypothesis, prior: 0.5, log_likelihood_ratio: 0.0 };
    relocalization.propose([proposal(1), proposal(2)]).unwrap();
    relocalization.observe(0.0, |_| 20.0).unwrap();
    assert!(relocalization.decide(&mut present));
    assert!(!relocalization.decide(&mut present));
    assert!(relocalization.probability() > 0.49, "two places are equally probable");
}

#[test]
fn search_alone_makes_the_odds_even_at_most() {
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    let found = RelocalizationCandidate { hypothesis: 1, prior: 0.5, log_likelihood_ratio: 1000.0 };
    relocalization.propose([found]).unwrap();
    assert_abs_diff_eq!(relocalization.probability(), 0.5, epsilon = 1e-12);
    assert!(!relocalization.decide(&mut 0));
}

#[test]
fn all_proposals_of_a_search_share_even_odds() {
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    let found = |hypothesis, log_likelihood_ratio| RelocalizationCandidate {
        hypothesis,
        prior: 0.1,
        log_likelihood_ratio,
    };
    relocalization
        .propose([found(1, 50.0), found(2, 50.0 - 3_f64.ln()), found(3, 50.0 - 3_f64.ln())])
        .unwrap();
    assert_abs_diff_eq!(relocalization.probability(), 0.5, epsilon = 1e-12);
    // They keep their ratios: 3 to 1 to 1.
    let [best, other, _] = relocalization.alternatives() else { panic!("three") };
    assert_abs_diff_eq!(best.statistic() / other.statistic(), 3.0, epsilon = 1e-9);
}

#[test]
fn unknown_start_is_decided_at_even_odds() {
    let mut present = 0;
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    // The last one is less probable by more than the odds of a decision, 1 to 100.
    relocalization.start([(1, -1.0), (2, -2.0), (3, -5.0)]).unwrap();
    assert_eq!(relocalization.alternatives().len(), 2);
    let odds = (-1_f64).exp() + (-2_f64).exp();
    assert_abs_diff_eq!(relocalization.probability(), odds / (1.0 + odds), epsilon = 1e-12);
    assert!(!relocalization.decide(&mut present));
    relocalization.observe(0.0, |hypothesis| if *hypothesis == 1 { 1.5 } else { 0.0 }).unwrap();
    assert!(relocalization.decide(&mut present) && present == 1);
    assert!(!relocalization.decide(&mut present), "the previous one is an alternative again");
    assert_eq!(relocalization.alternatives().len(), 2);
}

#[test]
fn unknown_start_is_decided_without_relocalization_too() {
    let mut present = 0;
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::off()).unwrap();
    relocalization.start([(1, -1.0), (2, -5.0)]).unwrap();
    assert_eq!(relocalization.alternatives().len(), 1, "the last one is hopeless");
    relocalization.observe(0.0, |_| 1.5).unwrap();
    assert!(relocalization.decide(&mut present) && present == 1);
}

#[test]
fn the_better_of_two_alternatives_at_one_place_stays() {
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    let candidate = |(hypothesis, log_likelihood_ratio)| RelocalizationCandidate {
        hypothesis,
        prior: 0.1,
        log_likelihood_ratio,
    };
    relocalization.propose([(10, 0.0), (20, 0.0), (11, 2.0), (1, 3.0)].map(candidate)).unwrap();
    // Within 1 of the present place, 0, or of one another.
    relocalization.remove_duplicates(&0, |one, other| i32::abs(one - other) <= 1);
    let left: Vec<i32> = relocalization.alternatives().iter().map(|one| one.hypothesis).collect();
    assert_eq!(left, [20, 11]);
}

#[test]
fn invalid_numbers_change_nothing() {
    let mut relocalization = RelocalizationTest::new(RelocalizationParams::default()).unwrap();
    relocalization
        .propose([RelocalizationCandidate { hypothesis: 1, prior: 0.5, log_likelihood_ratio: 2.0 }])
        .unwrap();
    let before = relocalization.clone();
    assert!(matches!(relocalization.drive(-1.0), Err(IntegrityError::OutOfRange { .. })));
    assert!(relocalization.drive(f64::NAN).is_err());
    assert!(relocalization.observe(f64::NAN, |_| 0.0).is_err());
    assert!(relocalization.observe(f64::NEG_INFINITY, |_| f64::NEG_INFINITY).is_err());
    for prior in [0.0, -1.0, 1.5, f64::NAN] {
        assert!(
            relocalization
                .propose([RelocalizationCandidate { hypothesis: 2, prior, log_likelihood_ratio: 2.0 }])
                .is_err()
        );
    }
    assert_eq!(relocalization, before);
    let params = RelocalizationParams { kidnappings_per_km: 0.001, ..Default::default() };
    assert!(RelocalizationTest::<u8>::new(params).is_err(), "alarms would be wrong more often than right");
}
