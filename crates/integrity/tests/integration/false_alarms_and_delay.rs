//! False alarms and delays over Gaussian measurements, beside the known values of the tests.
#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::abs_diff_eq;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use wayfix_integrity::{
    CusumTest, ProbabilityRatioTest, RatioVerdict, RelocalizationParams, ShiryaevRobertsTest,
};

const SEED: u64 = 41;
const N_RUNS: usize = 1000;
/// The mean of the measurements after the change; it is 0 before. Variance 1.
const SHIFT: f64 = 1.0;

/// Mean number of measurements to an alarm, and the half-width of its 95 % interval.
fn mean_run_length(mean: f64, mut alarm: impl FnMut(usize, f64) -> bool) -> (f64, f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let normal = Normal::new(mean, 1.0).unwrap();
    let lengths: Vec<f64> = (0..N_RUNS)
        .map(|run| {
            (1..).find(|_| alarm(run, normal.sample(&mut rng) * SHIFT - SHIFT * SHIFT / 2.0)).unwrap() as f64
        })
        .collect();
    let n = N_RUNS as f64;
    let average = lengths.iter().sum::<f64>() / n;
    let variance = lengths.iter().map(|length| (length - average).powi(2)).sum::<f64>() / (n - 1.0);
    (average, 1.96 * (variance / n).sqrt())
}

fn cusum(mean: f64, threshold: f64) -> (f64, f64) {
    let fresh = CusumTest::from_false_alarm_rate((-threshold).exp()).unwrap();
    let (mut sum, mut current) = (fresh, 0);
    mean_run_length(mean, |run, ratio| {
        if run != current {
            (sum, current) = (fresh, run);
        }
        sum.observe(ratio).unwrap()
    })
}

fn shiryaev_roberts(mean: f64, distance: f64, false_alarms_per_km: f64) -> (f64, f64) {
    let params = RelocalizationParams { false_alarms_per_km, kidnappings_per_km: 1e3, ..Default::default() };
    let fresh = ShiryaevRobertsTest::new(params).unwrap();
    let (mut test, mut current) = (fresh, 0);
    mean_run_length(mean, |run, ratio| {
        if run != current {
            (test, current) = (fresh, run);
        }
        test.observe(distance, ratio).unwrap();
        test.is_change()
    })
}

/// [Siegmund 1985, Eq. 2.57]: the mean run length of a cumulative sum of increments with mean `drift` and variance 1.
fn siegmund(drift: f64, threshold: f64) -> f64 {
    const OVERSHOOT: f64 = 2.0 * 0.583;
    let limit = threshold + OVERSHOOT;
    ((-2.0 * drift * limit).exp() + 2.0 * drift * limit - 1.0) / (2.0 * drift * drift)
}

#[test]
fn cusum_has_the_run_lengths_of_siegmund() {
    for (mean, threshold) in [(0.0, 3.0), (0.0, 4.0), (SHIFT, 4.0), (SHIFT, 5.0)] {
        let (measured, interval) = cusum(mean, threshold);
        let known = siegmund(mean - SHIFT / 2.0, threshold);
        // Siegmund's approximation is good to a few per cent.
        assert!(
            abs_diff_eq!(measured, known, epsilon = interval + 0.03 * known),
            "{measured} ± {interval}, known {known}"
        );
    }
}

#[test]
fn cusum_keeps_the_bound_of_lorden() {
    for threshold in [2.0_f64, 3.0, 4.0] {
        let (measured, interval) = cusum(0.0, threshold);
        assert!(measured - interval > threshold.exp(), "{measured} ± {interval}");
    }
}

#[test]
fn distance_between_false_alarms_keeps_its_bound() {
    for (distance, false_alarms_per_km) in [(1.0, 10.0), (0.5, 10.0), (0.1, 50.0)] {
        let threshold = 1000.0 / false_alarms_per_km;
        let (n, interval) = shiryaev_roberts(0.0, distance, false_alarms_per_km);
        let (measured, interval) = (n * distance, interval * distance);
        assert!(measured + interval > threshold, "{measured} ± {interval} m, bound {threshold} m");
        // Without overshoot the bound is exact; the overshoot of normal increments is exp(0.583 δ). [Pollak 1987]
        let known = threshold * (0.583 * SHIFT).exp();
        assert!(
            abs_diff_eq!(measured, known, epsilon = interval + 0.05 * known),
            "{measured} ± {interval} m, known {known} m"
        );
    }
}

#[test]
fn delay_grows_with_the_logarithm_of_the_threshold() {
    // To first order the delay is ln(A) / I, with I = δ²/2 nats per measurement. [Lorden 1971]
    let delays = [1.0, 0.01].map(|rate| shiryaev_roberts(SHIFT, 1.0, rate));
    let [(short, a), (long, b)] = delays;
    let known = 100_f64.ln() / (SHIFT * SHIFT / 2.0);
    assert!(
        abs_diff_eq!(long - short, known, epsilon = a + b),
        "{short} ± {a} and {long} ± {b} measurements"
    );
}

#[test]
fn ratio_test_keeps_its_error_rate_for_any_length() {
    const RATE: f64 = 0.05;
    let fresh = ProbabilityRatioTest::from_error_rate(RATE).unwrap();
    let (mut test, mut current, mut n_wrong, mut verdict) = (fresh, 0, 0, RatioVerdict::Undecided);
    // The first hypothesis holds; a run ends with a verdict.
    let (length, interval) = mean_run_length(0.0, |run, ratio| {
        if run != current {
            n_wrong += usize::from(verdict == RatioVerdict::Second);
            (test, current) = (fresh, run);
        }
        verdict = test.observe(ratio).unwrap();
        verdict != RatioVerdict::Undecided
    });
    // Ville's bound; the count has a standard deviation of sqrt(N RATE).
    let bound = N_RUNS as f64 * RATE;
    assert!(n_wrong > 0 && (n_wrong as f64) < bound + 2.0 * bound.sqrt(), "{n_wrong} of {N_RUNS}");
    // Wald: about -ln RATE / I measurements, I = δ²/2, and the overshoot of 0.583 δ at the bound.
    let known = (-RATE.ln() + 0.583 * SHIFT) / (SHIFT * SHIFT / 2.0);
    assert!(
        abs_diff_eq!(length, known, epsilon = interval + 0.1 * known),
        "{length} ± {interval}, known {known}"
    );
    assert!(ProbabilityRatioTest::from_error_rate(0.0).is_err());
    let mut test = fresh.with_sum(f64::INFINITY).unwrap();
    assert!(test.observe(f64::NEG_INFINITY).is_err() && test.verdict() == RatioVerdict::Second);
}
