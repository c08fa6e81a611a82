//! NEES and NIS of a consistent filter lie in their 95 % band; those of an inconsistent one do not.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use crate::common::{constant_velocity, position_sensor};
use nalgebra::{Vector2, Vector4};
use rand::{SeedableRng, distr::Distribution};
use rand_chacha::ChaCha8Rng;
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{ConsistencyStatistics, KalmanFilter, nees};

/// Seeds 1..=200: 200 runs of 50 steps.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=200;
const STEPS: usize = 50;
const Q: f64 = 0.5;
const R: f64 = 0.25;

/// NEES of the last step over runs, which are independent; NIS over all steps, which are white.
fn simulate(assumed_q: f64, assumed_r: f64) -> (ConsistencyStatistics, ConsistencyStatistics) {
    let (mut errors, mut innovations) = (ConsistencyStatistics::new(4), ConsistencyStatistics::new(2));
    let truth_motion = constant_velocity(Q);
    let motion_noise = Gaussian::from_parts_unchecked(Vector4::zeros(), *truth_motion.noise()).sampler();
    let sensor_noise = Gaussian::from_sigmas(Vector2::zeros(), &Vector2::repeat(R.sqrt())).unwrap().sampler();
    for seed in SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let prior = Gaussian::from_sigmas(Vector4::zeros(), &Vector4::new(1.0, 1.0, 0.5, 0.5)).unwrap();
        let mut truth = prior.sample(&mut rng);
        let mut filter = KalmanFilter::new(constant_velocity(assumed_q), prior).unwrap();
        let sensor = position_sensor(assumed_r);
        for _ in 0..STEPS {
            truth = truth_motion.transition() * truth + motion_noise.sample(&mut rng);
            filter.predict(None).unwrap();
            let measurement = truth.xy() + sensor_noise.sample(&mut rng);
            innovations.push(filter.update(&sensor, &measurement).unwrap().nis());
        }
        errors.push(nees(filter.estimate(), &truth).unwrap());
    }
    (errors, innovations)
}

#[test]
fn a_filter_that_knows_its_noise_is_consistent() {
    let (errors, innovations) = simulate(Q, R);
    assert_eq!((errors.count(), innovations.count()), (200, 10_000));
    for consistency in [errors, innovations] {
        let band = consistency.band(0.95).unwrap();
        assert!(band.contains(consistency.average()), "{} outside {band:?}", consistency.average());
    }
}

#[test]
fn overconfident_filter_is_above_and_timid_below_the_band() {
    let (errors, innovations) = simulate(Q / 10.0, R / 2.0);
    for consistency in [errors, innovations] {
        assert!(consistency.average() > consistency.band(0.95).unwrap().high, "{}", consistency.average());
    }
    let (errors, innovations) = simulate(Q * 4.0, R * 2.0);
    for consistency in [errors, innovations] {
        assert!(consistency.average() < consistency.band(0.95).unwrap().low, "{}", consistency.average());
    }
}
