//! What the auxiliary filter gains on a sharp measurement, against closed forms.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its models has failed")]

use crate::common::Runs;
use nalgebra::{Matrix1, U1, Vector1};
use rand::SeedableRng;
use rand::distr::Distribution as _;
use rand_chacha::ChaCha8Rng;
use wayfix_gaussian_core::{Gaussian, GaussianLikelihood, GaussianMotionSampler};
use wayfix_kalman::{LinearMotion, LinearSensor};
use wayfix_particle::{AuxiliaryFilter, BootstrapFilter, ParticleSet};

type Line = Vector1<f64>;

const PRIOR_SIGMA: f64 = 1.0;
const MOTION_SIGMA: f64 = 0.025;
const SENSOR_SIGMA: f64 = 0.1;
const N: usize = 20_000;

/// $`E[w]^2 / E[w^2]`$: the share of particles that is effective in the limit of many.
fn share(moment: impl Fn(f64) -> f64) -> f64 {
    moment(1.0).powi(2) / moment(2.0)
}

/// $`E[w^k]`$ for $`w = e^{-b x'^2/2}`$ with $`x'`$ as predicted.
fn bootstrap_moment(k: f64) -> f64 {
    let (predicted, b) = (PRIOR_SIGMA.powi(2) + MOTION_SIGMA.powi(2), SENSOR_SIGMA.powi(-2));
    (1.0 + k * predicted * b).sqrt().recip()
}

/// $`E[w^k]`$ for $`w = e^{-b(x'^2 - x^2)/2}`$ with $`x`$ from the first stage and $`x' = x + e`$: two Gaussian integrals.
fn auxiliary_moment(k: f64) -> f64 {
    let (a, b) = (MOTION_SIGMA.powi(-2), SENSOR_SIGMA.powi(-2));
    let first_stage = (PRIOR_SIGMA.powi(-2) + b).recip();
    let curvature = (k * b).powi(2) / (a + k * b);
    (a / (a + k * b)).sqrt() / (1.0 - first_stage * curvature).sqrt()
}

#[test]
fn effective_share_after_sharp_measurement_matches_integral() {
    let motion = LinearMotion::<f64, U1>::stationary(Matrix1::new(MOTION_SIGMA.powi(2))).unwrap();
    let sensor =
        LinearSensor::<Line, Line>::new(Matrix1::identity(), Matrix1::new(SENSOR_SIGMA.powi(2))).unwrap();
    let sensor = GaussianLikelihood(sensor);
    let prior = Gaussian::from_sigmas(Line::zeros(), &Line::new(PRIOR_SIGMA)).unwrap().sampler();
    let measured = Line::zeros();
    let (mut bootstrap, mut auxiliary) = (vec![], vec![]);
    for seed in 0..30 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let particles = ParticleSet::from_fn(N, |rng| prior.sample(rng), &mut rng).unwrap();
        let mut filter =
            BootstrapFilter::new(particles.clone(), GaussianMotionSampler(motion.clone()), sensor.clone());
        filter.predict(&None, &mut rng).unwrap();
        bootstrap.push(filter.update(&measured).unwrap().effective_share());
        let mut filter = AuxiliaryFilter::new(particles, motion.clone(), sensor.clone());
        auxiliary.push(filter.step(&None, &measured, &mut rng).unwrap().effective_share());
    }
    let (expected_bootstrap, expected_auxiliary) = (share(bootstrap_moment), share(auxiliary_moment));
    assert!(expected_auxiliary > 5.0 * expected_bootstrap, "{expected_auxiliary}, {expected_bootstrap}");
    // A ratio of averages has a bias of order 1/n.
    Runs(&bootstrap).agree_with(expected_bootstrap, 10.0 / N as f64);
    Runs(&auxiliary).agree_with(expected_auxiliary, 10.0 / N as f64);
}
