//! Each scheme keeps the laws and has the variance that its paper promises.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its weights has failed")]

use approx::abs_diff_eq;
use rand::{Rng, RngExt as _, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_particle::{
    MultinomialResampler, NormalizedWeights, Resampler, ResidualResampler, StratifiedResampler,
    SystematicResampler, laws,
};

const SEED: u64 = 20_261_121;
const REPEATS: usize = 20_000;

fn weights(raw: &[f64]) -> NormalizedWeights {
    NormalizedWeights::from_linear(raw.to_vec()).unwrap()
}

/// Skewed, with gaps at both ends, and equal ones whose products with `n` round to either side of a whole number.
fn cases() -> Vec<(NormalizedWeights, usize)> {
    vec![
        (weights(&[0.0, 5.0, 0.1, 0.0, 1.0, 1e-6, 3.0, 0.0]), 13),
        (weights(&[0.3, 0.7]), 1),
        (weights(&[1.0; 49]), 49),
        (weights(&[1.0; 10]), 37),
        (weights(&[0.0, 0.0, 1.0]), 4),
    ]
}

fn counts<S: Resampler>(scheme: &S, weights: &NormalizedWeights, n: usize, rng: &mut impl Rng) -> Vec<f64> {
    let mut counts = vec![0.0; weights.as_slice().len()];
    scheme.ancestors(weights, n, rng).unwrap().into_iter().for_each(|i| counts[i] += 1.0);
    counts
}

#[test]
fn every_scheme_keeps_the_laws() {
    fn check<S: Resampler>(scheme: &S) {
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        for (weights, n) in cases() {
            laws::resampler(scheme, &weights, n, REPEATS, &mut rng).unwrap();
        }
    }
    check(&SystematicResampler);
    check(&StratifiedResampler);
    check(&ResidualResampler);
    check(&MultinomialResampler);
}

#[test]
fn the_laws_catch_schemes_that_break_them() {
    /// Children in proportion to their number, not their weight.
    struct Uniform;
    impl Resampler for Uniform {
        fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R) {
            let n = weights.as_slice().len();
            ancestors.fill_with(|| rng.random_range(0..n));
            ancestors.sort_unstable();
        }
    }
    /// A comb that always starts at the same place.
    struct Stuck;
    impl Resampler for Stuck {
        fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], _: &mut R) {
            SystematicResampler.fill(weights, ancestors, &mut ChaCha8Rng::seed_from_u64(SEED));
        }
    }
    /// Rightly drawn, but out of order.
    struct Shuffled;
    impl Resampler for Shuffled {
        fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], rng: &mut R) {
            SystematicResampler.fill(weights, ancestors, rng);
            ancestors.reverse();
        }
    }
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let skewed = weights(&[1.0, 2.0, 4.0]);
    let law = |violation: Result<(), laws::LawViolation>| violation.unwrap_err().law;
    assert!(law(laws::resampler(&Uniform, &skewed, 5, REPEATS, &mut rng)).starts_with("unbiased"));
    assert!(law(laws::resampler(&Stuck, &skewed, 5, REPEATS, &mut rng)).starts_with("unbiased"));
    assert!(law(laws::resampler(&Shuffled, &skewed, 5, REPEATS, &mut rng)).starts_with("ancestors ascend"));
    let gap = weights(&[1.0, 0.0, 1.0]);
    assert!(law(laws::resampler(&Uniform, &gap, 5, REPEATS, &mut rng)).starts_with("a particle without"));
}

/// Pearson's statistic of all draws together has a chi-squared distribution for independent draws, one degree of freedom less than particles.
#[test]
fn multinomial_counts_pass_pearsons_test() {
    let weights = weights(&[0.5, 2.0, 1.0, 0.25, 3.0, 0.1]);
    let band = ChiSquaredBand::for_average(weights.as_slice().len() - 1, 1, 0.9999).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let counts = counts(&MultinomialResampler, &weights, 200_000, &mut rng);
    let pearson: f64 = counts
        .iter()
        .zip(weights.as_slice())
        .map(|(count, share)| (count - 2e5 * share).powi(2) / (2e5 * share))
        .sum();
    assert!(band.contains(pearson), "{pearson} is not in {band:?}");
}

/// [Douc, Cappé & Moulines 2005]
#[test]
fn counts_stay_as_close_to_expectation_as_each_scheme_promises() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    for _ in 0..500 {
        let raw: Vec<f64> = (0..20).map(|_| rng.random::<f64>().powi(4)).collect();
        let (weights, n) = (weights(&raw), rng.random_range(1..60));
        let systematic = counts(&SystematicResampler, &weights, n, &mut rng);
        let stratified = counts(&StratifiedResampler, &weights, n, &mut rng);
        let residual = counts(&ResidualResampler, &weights, n, &mut rng);
        for (i, share) in weights.as_slice().iter().enumerate() {
            let expected = share * n as f64;
            assert!(
                abs_diff_eq!(systematic[i], expected, epsilon = 1.0),
                "systematic: {} for {expected}",
                systematic[i]
            );
            assert!(
                abs_diff_eq!(stratified[i], expected, epsilon = 2.0),
                "stratified: {} for {expected}",
                stratified[i]
            );
            assert!(residual[i] >= expected.floor(), "residual: {} for {expected}", residual[i]);
        }
    }
}

/// Stratified and residual draws never estimate a mean worse than multinomial ones, whose variance is known in closed form.
/// [Douc, Cappé & Moulines 2005]
#[test]
fn variances_come_in_the_order_of_the_theorems() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let n = 10;
    let raw: Vec<f64> = (0..20).map(|_| rng.random::<f64>().powi(2)).collect();
    let weights = weights(&raw);
    let value = |i: usize| (i as f64 * 0.7).sin();
    let mean: f64 = weights.as_slice().iter().enumerate().map(|(i, w)| w * value(i)).sum();
    let square: f64 = weights.as_slice().iter().enumerate().map(|(i, w)| w * value(i).powi(2)).sum();
    let exact = (square - mean * mean) / n as f64;

    fn mean_square_error<S: Resampler>(
        scheme: &S,
        weights: &NormalizedWeights,
        n: usize,
        deviation: impl Fn(&[usize]) -> f64,
        rng: &mut ChaCha8Rng,
    ) -> f64 {
        let squares =
            (0..REPEATS).map(|_| deviation(&scheme.ancestors(weights, n, rng).unwrap()).powi(2)).sum::<f64>();
        squares / REPEATS as f64
    }
    let deviation = |ancestors: &[usize]| ancestors.iter().map(|i| value(*i)).sum::<f64>() / n as f64 - mean;
    // A variance estimated from m nearly normal values has the relative standard error sqrt(2/m); five of them.
    let slack = 1.0 + 5.0 * (2.0 / REPEATS as f64).sqrt();
    let multinomial = mean_square_error(&MultinomialResampler, &weights, n, deviation, &mut rng);
    assert!(multinomial < exact * slack && multinomial > exact / slack, "{multinomial} against {exact}");
    for (scheme, variance) in [
        ("stratified", mean_square_error(&StratifiedResampler, &weights, n, deviation, &mut rng)),
        ("residual", mean_square_error(&ResidualResampler, &weights, n, deviation, &mut rng)),
    ] {
        assert!(variance < exact * slack, "{scheme}: {variance} against {exact}");
    }
}
