//! KLD-sampling against the distribution that it approximates, and against its promise.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its sampler has failed")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use rand::{RngExt as _, SeedableRng};
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};
use wayfix_particle::{KldParams, KldSampling, ParticleError, ParticleSet, grid_cell};

const SEED: u64 = 20_261_121;

/// $`n = χ^2_{k-1,1-δ} / 2ε`$ [Fox 2003] with the quantile itself; the formula that everyone uses is Wilson and Hilferty's
/// approximation, good to 1 % from two degrees of freedom on and to 3 % at one. [Johnson, Kotz & Balakrishnan 1994, Ch. 18]
#[test]
fn kld_particle_counts_match_chi_squared_quantiles() {
    for confidence in [0.9, 0.95, 0.99] {
        for epsilon in [0.01, 0.05, 0.2] {
            let kld = KldSampling::new(KldParams {
                epsilon,
                confidence,
                min_particles: 1,
                max_particles: usize::MAX,
            })
            .unwrap();
            for n_bins in [2, 3, 10, 100, 1000, 100_000] {
                let quantile = ChiSquared::new(n_bins as f64 - 1.0).unwrap().inverse_cdf(confidence);
                let (exact, got) = (quantile / (2.0 * epsilon), kld.required(n_bins) as f64);
                let relative = if n_bins == 2 { 0.03 } else { 0.01 };
                assert!(
                    abs_diff_eq!(got, exact, epsilon = relative * exact + 1.0),
                    "{n_bins} bins: {got}, exact {exact}"
                );
            }
        }
    }
}

/// With that many samples of a known histogram the divergence stays below ε as often as promised. The chi-squared limit is for many samples a
/// bin, so ε is small.
#[test]
fn the_promise_about_the_divergence_is_kept() {
    let (epsilon, confidence, n_bins, trials) = (0.01, 0.95, 20, 2000);
    let kld =
        KldSampling::new(KldParams { epsilon, confidence, min_particles: 1, max_particles: usize::MAX })
            .unwrap();
    let n = kld.required(n_bins);
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut kept = 0;
    for _ in 0..trials {
        let mut counts = vec![0.0; n_bins];
        (0..n).for_each(|_| counts[rng.random_range(0..n_bins)] += 1.0 / n as f64);
        let divergence: f64 = counts
            .iter()
            .filter(|share| **share > 0.0)
            .map(|share| share * (share * n_bins as f64).ln())
            .sum();
        kept += usize::from(divergence <= epsilon);
    }
    // Five standard errors of a share of 2000 trials.
    let slack = 5.0 * (confidence * (1.0 - confidence) / trials as f64).sqrt();
    let share = kept as f64 / trials as f64;
    assert_abs_diff_eq!(share, confidence, epsilon = slack);
}

#[test]
fn the_number_follows_the_spread_within_its_bounds() {
    let kld = KldSampling::new(KldParams { min_particles: 50, max_particles: 3000, ..KldParams::default() })
        .unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut size = |width: f64| {
        let particles = ParticleSet::from_fn(5000, |rng| rng.random_range(0.0..width), &mut rng).unwrap();
        particles.kld_size(&kld, |x| grid_cell([*x], [1.0]), &mut rng).unwrap()
    };
    assert_eq!(size(1.0), 50);
    // 30 bins are all met long before the draws end; then it is the number for 30.
    assert_eq!(size(30.0), kld.required(30));
    assert_eq!(size(1e6), 3000);
}

#[test]
fn particles_without_weight_occupy_no_bin() {
    let kld = KldSampling::new(KldParams { min_particles: 10, ..KldParams::default() }).unwrap();
    let states: Vec<f64> = (0..1000).map(f64::from).collect();
    let log_weights = states.iter().map(|x| if *x == 500.0 { -700.0 } else { f64::NEG_INFINITY }).collect();
    let particles = ParticleSet::from_log_weights(states, log_weights).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    assert_eq!(particles.kld_size(&kld, |x| grid_cell([*x], [1.0]), &mut rng).unwrap(), 10);
}

#[test]
fn parameters_out_of_range_are_named() {
    let good = KldParams::default();
    for (params, what) in [
        (KldParams { epsilon: 0.0, ..good }, "epsilon"),
        (KldParams { epsilon: f64::NAN, ..good }, "epsilon"),
        (KldParams { confidence: 1.0, ..good }, "confidence"),
        (KldParams { confidence: 0.1, ..good }, "confidence"),
        (KldParams { min_particles: 0, ..good }, "min_particles"),
        (KldParams { max_particles: 99, ..good }, "max_particles"),
    ] {
        let refused = KldSampling::new(params);
        assert!(matches!(refused, Err(ParticleError::Parameter { what: named, .. }) if named == what));
    }
    assert_eq!(grid_cell([f64::NAN, f64::INFINITY], [1.0, 1.0]), [0, i64::MAX]);
}
