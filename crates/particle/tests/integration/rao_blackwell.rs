//! Rao-Blackwellised particles against enumeration, against plain particles, and what they keep in memory.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its models has failed")]

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{Matrix1, U1, Vector1};
use rand::distr::Distribution as _;
use rand::{RngExt as _, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_gaussian_core::{Gaussian, log_sum_exp};
use wayfix_kalman::{KalmanError, KalmanFilter, LinearMotion, LinearSensor};
use wayfix_particle::{
    ParticleChunkRng, ParticleError, ParticleSet, RaoBlackwellParticle, SystematicResampler, map_conditionals,
};

use crate::common::{Runs, standard_error};

type Conditional = KalmanFilter<f64, U1>;
type Sensor = LinearSensor<Vector1<f64>, Vector1<f64>>;
type Particles = ParticleSet<RaoBlackwellParticle<usize, Conditional>>;

/// A sensor that is now sharp, now blurred; the regime changes with probability 0.2 a step.
const SIGMAS: [f64; 2] = [0.1, 2.0];
const CHANGE: f64 = 0.2;
const MEASUREMENTS: [f64; 8] = [0.1, 2.9, -1.8, 0.25, 0.31, 0.2, 2.2, 0.9];
const RUNS: u64 = 200;
const N: usize = 200;

#[derive(Debug)]
enum StepError {
    Particle,
    Kalman,
}
impl From<ParticleError> for StepError {
    fn from(_: ParticleError) -> Self {
        Self::Particle
    }
}
impl From<KalmanError> for StepError {
    fn from(_: KalmanError) -> Self {
        Self::Kalman
    }
}

fn sensor(regime: usize) -> Sensor {
    LinearSensor::<Vector1<f64>, Vector1<f64>>::new(Matrix1::identity(), Matrix1::new(SIGMAS[regime].powi(2)))
        .unwrap()
}

fn prior() -> Gaussian<Vector1<f64>> {
    Gaussian::from_sigmas(Vector1::new(0.0), &Vector1::new(1.0)).unwrap()
}

fn conditional() -> Conditional {
    let motion = LinearMotion::<f64, U1>::stationary(Matrix1::new(0.04)).unwrap();
    KalmanFilter::new(motion, prior()).unwrap()
}

/// What all methods compute after the last measurement.
#[derive(Clone, Copy)]
struct Answer {
    log_evidence: f64,
    /// Probability of the blurred regime.
    blurred: f64,
    mean: f64,
}

/// All 256 sequences of regimes, one Kalman filter each.
fn exact() -> Answer {
    let mut leaves = vec![];
    for sequence in 0..1_usize << MEASUREMENTS.len() {
        let (mut filter, mut log_weight, mut previous) = (conditional(), 0.0, None);
        for (k, z) in MEASUREMENTS.iter().enumerate() {
            let regime = sequence >> k & 1;
            log_weight += match previous {
                None => 0.5_f64.ln(),
                Some(same) if same == regime => (1.0 - CHANGE).ln(),
                Some(_) => CHANGE.ln(),
            };
            filter.predict(None).unwrap();
            log_weight += filter.update(&sensor(regime), &Vector1::new(*z)).unwrap().log_likelihood();
            previous = Some(regime);
        }
        leaves.push((log_weight, previous.unwrap(), filter.estimate().mean()[0]));
    }
    let log_weights: Vec<f64> = leaves.iter().map(|leaf| leaf.0).collect();
    let log_evidence = log_sum_exp(&log_weights);
    let expected = |value: &dyn Fn(usize, f64) -> f64| {
        leaves.iter().map(|(l, regime, mean)| (l - log_evidence).exp() * value(*regime, *mean)).sum()
    };
    Answer { log_evidence, blurred: expected(&|regime, _| regime as f64), mean: expected(&|_, mean| mean) }
}

fn next_regime(k: usize, regime: usize, rng: &mut ParticleChunkRng) -> usize {
    let change = rng.random_bool(if k == 0 { 0.5 } else { CHANGE });
    if change { 1 - regime } else { regime }
}

/// The regime is sampled, the position carried by a Kalman filter.
fn rao_blackwellised(seed: u64) -> Answer {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let shared = Arc::new(conditional());
    let start = (0..N).map(|_| RaoBlackwellParticle::from_shared(0, Arc::clone(&shared))).collect();
    let mut particles: Particles = ParticleSet::new(start).unwrap();
    let sensors = [sensor(0), sensor(1)];
    let mut log_evidence = 0.0;
    for (k, z) in MEASUREMENTS.iter().enumerate() {
        let condition = |regime: &usize, filter: &mut Conditional| {
            filter.predict(None)?;
            Ok::<_, StepError>(filter.update(&sensors[*regime], &Vector1::new(*z))?.log_likelihood())
        };
        particles
            .sample_and_condition(|regime, rng| next_regime(k, *regime, rng), condition, &mut rng)
            .unwrap();
        log_evidence += particles.normalize().unwrap().log_likelihood;
        if k + 1 < MEASUREMENTS.len() {
            particles.resample(&SystematicResampler, N, &mut rng).unwrap();
        }
    }
    let mean = |value: &dyn Fn(&RaoBlackwellParticle<usize, Conditional>) -> f64| {
        particles.moments(|particle| Vector1::new(value(particle))).unwrap().mean[0]
    };
    Answer {
        log_evidence,
        blurred: mean(&|particle| particle.sampled as f64),
        mean: mean(&|particle| particle.conditional().estimate().mean()[0]),
    }
}

/// Regime and position are both sampled.
fn plain(seed: u64) -> Answer {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let start = prior().sampler();
    let mut particles = ParticleSet::from_fn(N, |rng| (0_usize, start.sample(rng)[0]), &mut rng).unwrap();
    let noise = Gaussian::from_sigmas(Vector1::new(0.0), &Vector1::new(0.2)).unwrap().sampler();
    let mut log_evidence = 0.0;
    for (k, z) in MEASUREMENTS.iter().enumerate() {
        let motion = |(regime, x): &mut (usize, f64), rng: &mut ParticleChunkRng| {
            *regime = next_regime(k, *regime, rng);
            *x += noise.sample(rng)[0];
        };
        particles.propagate(motion, &mut rng);
        let half_log_tau = 0.5 * std::f64::consts::TAU.ln();
        particles
            .reweigh(|(regime, x)| {
                -0.5 * ((z - x) / SIGMAS[*regime]).powi(2) - SIGMAS[*regime].ln() - half_log_tau
            })
            .unwrap();
        log_evidence += particles.normalize().unwrap().log_likelihood;
        if k + 1 < MEASUREMENTS.len() {
            particles.resample(&SystematicResampler, N, &mut rng).unwrap();
        }
    }
    let moments = particles.moments(|(regime, x)| nalgebra::Vector2::new(*regime as f64, *x)).unwrap();
    Answer { log_evidence, blurred: moments.mean[0], mean: moments.mean[1] }
}

#[test]
fn rao_blackwellised_particles_match_the_enumeration() {
    let exact = exact();
    let part = |answers: &[Answer], part: fn(&Answer) -> f64| answers.iter().map(part).collect::<Vec<f64>>();
    let mut spreads = vec![];
    for method in [rao_blackwellised, plain] {
        let answers: Vec<Answer> = (0..RUNS).map(method).collect();
        let ratios: Vec<f64> =
            answers.iter().map(|answer| (answer.log_evidence - exact.log_evidence).exp()).collect();
        Runs(&ratios).agree_with(1.0, 0.0); // unbiased [Del Moral 2004, Prop. 7.4.1]
        // Normalized estimates have a bias of order 1/n; the scale of both is 1.
        Runs(&part(&answers, |answer| answer.blurred)).agree_with(exact.blurred, 2.0 / N as f64);
        Runs(&part(&answers, |answer| answer.mean)).agree_with(exact.mean, 2.0 / N as f64);
        spreads.push(standard_error(&part(&answers, |answer| answer.log_evidence)).powi(2));
    }
    // [Doucet et al. 2000]: integrating a part out never raises the variance. 1.7 is five standard errors of a ratio of two variances.
    assert!(spreads[0] * 1.7 < spreads[1], "variances of the log evidence: {spreads:?}");
}

#[test]
fn a_failing_conditional_leaves_all_particles_alone() {
    let mut rng = ChaCha8Rng::seed_from_u64(20_261_121);
    let start = (0..100).map(|i| RaoBlackwellParticle::new(i, vec![0.0])).collect();
    let mut particles = ParticleSet::new(start).unwrap();
    let before = particles.clone();
    let condition = |i: &i32, c: &mut Vec<f64>| {
        c[0] += 1.0;
        if *i == 70 { Err(StepError::Kalman) } else { Ok(-1.0) }
    };
    let refused = particles.sample_and_condition(|i, _| *i, condition, &mut rng);
    assert!(matches!(refused, Err(StepError::Kalman)));
    assert_eq!(particles, before);
    let nan = particles.sample_and_condition(|i, _| *i, |_, _| Ok::<_, ParticleError>(f64::NAN), &mut rng);
    assert!(matches!(nan, Err(ParticleError::LogWeight { index: 0, .. })));
    assert_eq!(particles, before);
}

/// Counts how often it was deep-copied and how many of it there are.
struct Counted<'a> {
    copies: &'a AtomicUsize,
    alive: &'a AtomicUsize,
}
impl<'a> Counted<'a> {
    fn new(copies: &'a AtomicUsize, alive: &'a AtomicUsize) -> Self {
        alive.fetch_add(1, Ordering::Relaxed);
        Self { copies, alive }
    }
}
impl Clone for Counted<'_> {
    fn clone(&self) -> Self {
        self.copies.fetch_add(1, Ordering::Relaxed);
        Self::new(self.copies, self.alive)
    }
}
impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.alive.fetch_sub(1, Ordering::Relaxed);
    }
}

#[test]
fn resampling_shares_ancestors_and_only_a_change_copies() {
    let (copies, alive) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let read = |counter: &AtomicUsize| counter.load(Ordering::Relaxed);
    let mut rng = ChaCha8Rng::seed_from_u64(20_261_121);
    let start = (0..1000).map(|i| RaoBlackwellParticle::new(i, Counted::new(&copies, &alive))).collect();
    let mut particles = ParticleSet::new(start).unwrap();
    particles.reweigh(|particle| -0.1 * f64::from(particle.sampled)).unwrap();
    let mut ancestors = particles.resample(&SystematicResampler, 1000, &mut rng).unwrap().to_vec();
    ancestors.dedup();

    assert_eq!(read(&copies), 0, "resampling copies no conditional");
    assert_eq!(particles.n_conditionals(), ancestors.len());
    assert_eq!(read(&alive), ancestors.len(), "those without children are gone from memory");
    let owners: usize = {
        let mut distinct = particles.states().to_vec();
        distinct.dedup_by(|a, b| a.shares_conditional_with(b));
        // `distinct` itself holds each of them once more.
        distinct.iter().map(|particle| Arc::strong_count(particle.shared_conditional()) - 1).sum()
    };
    assert_eq!(owners, 1000);

    let refused = map_conditionals(particles.states_mut(), |_| Err(StepError::Kalman));
    assert!(refused.is_err() && particles.n_conditionals() == ancestors.len());
    let mut steps = 0;
    let step = |_: &Counted<'_>| {
        steps += 1;
        Ok::<_, StepError>(Counted::new(&copies, &alive))
    };
    map_conditionals(particles.states_mut(), step).unwrap();
    assert_eq!(steps, ancestors.len(), "one step for all that share");
    assert_eq!((particles.n_conditionals(), read(&alive)), (ancestors.len(), ancestors.len()));

    let shared = 1000 - ancestors.len();
    particles.propagate(
        |particle, _| {
            particle.conditional_mut();
        },
        &mut rng,
    );
    assert_eq!(read(&alive), 1000);
    assert_eq!(read(&copies), shared, "the last owner of each changes it in place");
}
