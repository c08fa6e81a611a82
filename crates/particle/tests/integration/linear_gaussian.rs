//! On a linear Gaussian model the Kalman filter is exact: particle filters must agree with it up to their sampling error.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its models has failed")]

use crate::common::Runs;
use nalgebra::{Matrix1, Matrix1x2, Matrix2, U2, Vector1, Vector2};
use rand::SeedableRng;
use rand::distr::Distribution as _;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::laws;
use wayfix_gaussian_core::{Gaussian, GaussianLikelihood, GaussianMotionSampler};
use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor};
use wayfix_particle::{
    AuxiliaryFilter, BootstrapFilter, NormalizationReport, ParticleError, ParticleSet, SystematicResampler,
};

type State = Vector2<f64>;
type Sensor = GaussianLikelihood<LinearSensor<State, Vector1<f64>>>;
type Bootstrap = BootstrapFilter<GaussianMotionSampler<LinearMotion<f64, U2>>, Sensor>;
type Auxiliary = AuxiliaryFilter<LinearMotion<f64, U2>, Sensor>;

const RUNS: u64 = 200;

/// Position and velocity, a step of 0.1 s; the position is measured.
struct Problem {
    motion: LinearMotion<f64, U2>,
    sensor: LinearSensor<State, Vector1<f64>>,
    prior: Gaussian<State>,
    measurements: Vec<Vector1<f64>>,
}

impl Problem {
    fn new(motion_sigma: f64, sensor_sigma: f64) -> Self {
        let noise = Matrix2::from_diagonal(&Vector2::repeat(motion_sigma.powi(2)));
        Self {
            motion: LinearMotion::new(Matrix2::new(1.0, 0.1, 0.0, 1.0), noise).unwrap(),
            sensor: LinearSensor::<State, Vector1<f64>>::new(
                Matrix1x2::new(1.0, 0.0),
                Matrix1::new(sensor_sigma.powi(2)),
            )
            .unwrap(),
            prior: Gaussian::from_sigmas(Vector2::zeros(), &Vector2::new(1.0, 1.0)).unwrap(),
            measurements: (1..=15).map(|k| Vector1::new(0.4 + 0.06 * f64::from(k))).collect(),
        }
    }

    /// The exact posterior, and the exact evidence of all measurements.
    fn exact(&self) -> (Gaussian<State>, f64) {
        let mut filter = KalmanFilter::new(self.motion.clone(), self.prior.clone()).unwrap();
        let mut evidence = 0.0;
        for z in &self.measurements {
            filter.predict(None).unwrap();
            evidence += filter.update(&self.sensor, z).unwrap().log_likelihood();
        }
        (filter.estimate().clone(), evidence)
    }

    fn particles(&self, n: usize, rng: &mut ChaCha8Rng) -> ParticleSet<State> {
        let prior = self.prior.sampler();
        ParticleSet::from_fn(n, |rng| prior.sample(rng), rng).unwrap()
    }

    fn bootstrap_filter(&self, n: usize, rng: &mut ChaCha8Rng) -> Bootstrap {
        let (motion, sensor) =
            (GaussianMotionSampler(self.motion.clone()), GaussianLikelihood(self.sensor.clone()));
        BootstrapFilter::new(self.particles(n, rng), motion, sensor)
    }

    fn auxiliary_filter(&self, n: usize, rng: &mut ChaCha8Rng) -> Auxiliary {
        let (motion, sensor) = (self.motion.clone(), GaussianLikelihood(self.sensor.clone()));
        AuxiliaryFilter::new(self.particles(n, rng), motion, sensor)
    }

    /// The posterior mean of the position and the log evidence, from `n` particles.
    fn bootstrap(&self, n: usize, seed: u64) -> (f64, f64) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut filter = self.bootstrap_filter(n, &mut rng);
        let mut log_evidence = 0.0;
        for z in &self.measurements {
            filter.predict(&None, &mut rng).unwrap();
            let evidence = filter.update(z).unwrap();
            log_evidence += evidence.log_likelihood;
            if evidence.effective_share() < 0.5 {
                filter.particles_mut().resample(&SystematicResampler, n, &mut rng).unwrap();
            }
        }
        (filter.particles().moments(|x| *x).unwrap().mean[0], log_evidence)
    }

    fn auxiliary(&self, n: usize, seed: u64) -> (f64, f64) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut filter = self.auxiliary_filter(n, &mut rng);
        let log_evidence =
            self.measurements.iter().map(|z| filter.step(&None, z, &mut rng).unwrap().log_likelihood).sum();
        (filter.particles().moments(|x| *x).unwrap().mean[0], log_evidence)
    }

    fn agrees_with_the_kalman_filter(&self, n: usize, run: impl Fn(usize, u64) -> (f64, f64)) {
        let (posterior, log_evidence) = self.exact();
        let runs: Vec<_> = (0..RUNS).map(|seed| run(n, seed)).collect();
        // The estimate of the evidence (not of its logarithm) is unbiased for every number of particles. [Del Moral 2004, Prop. 7.4.1]
        let ratios: Vec<f64> = runs.iter().map(|(_, estimate)| (estimate - log_evidence).exp()).collect();
        Runs(&ratios).agree_with(1.0, 0.0);
        // The mean has a bias of order σ/n; ten of them are a hundredth of σ at n = 1000.
        let means: Vec<f64> = runs.iter().map(|(mean, _)| *mean).collect();
        Runs(&means).agree_with(posterior.mean()[0], 10.0 * posterior.sigmas()[0] / n as f64);
    }
}

#[test]
fn the_bootstrap_filter_agrees_with_the_kalman_filter() {
    let problem = Problem::new(0.1, 0.3);
    problem.agrees_with_the_kalman_filter(1000, |n, seed| problem.bootstrap(n, seed));
}

#[test]
fn the_auxiliary_filter_agrees_with_the_kalman_filter() {
    let problem = Problem::new(0.1, 0.3);
    problem.agrees_with_the_kalman_filter(1000, |n, seed| problem.auxiliary(n, seed));
}

/// Four times the particles, half the error (central limit theorem). The ratio of two variances from 200 runs each has a relative standard
/// error of sqrt(4/200) = 0.14, five of which are allowed.
#[test]
fn the_error_falls_with_the_root_of_the_number_of_particles() {
    let problem = Problem::new(0.1, 0.3);
    let (posterior, _) = problem.exact();
    let mean_square = |n: usize| {
        let errors = (1000..1000 + RUNS).map(|seed| problem.bootstrap(n, seed).0 - posterior.mean()[0]);
        errors.map(|error| error * error).sum::<f64>() / RUNS as f64
    };
    let ratio = mean_square(200) / mean_square(800);
    assert!((4.0 / 1.7..4.0 * 1.7).contains(&ratio), "ratio {ratio}, expected 4");
}

/// Ten measurements leave a sigma of 0.3/√10 ≈ 0.1 and particles from a prior of sigma 1.
const BOUND: f64 = 0.2;
const SEED: u64 = 20_261_121;

fn error(particles: &ParticleSet<State>) -> f64 {
    (particles.moments(|x| *x).unwrap().mean[0] - 0.8).abs()
}

#[test]
fn bootstrap_filter_obeys_the_laws_of_filters() {
    type Seeded = (Bootstrap, ChaCha8Rng);
    let sees = |z: f64| {
        move |(filter, rng): &mut Seeded| {
            let Ok(report) = filter.update(&Vector1::new(z)) else { return false };
            let resample = report.effective_share() < 0.5;
            !resample || filter.particles_mut().resample(&SystematicResampler, 1000, rng).is_ok()
        }
    };
    let drives = |x: f64, v: f64| {
        move |(filter, rng): &mut Seeded| filter.predict(&Some(Vector2::new(x, v)), rng).is_ok()
    };
    let good: laws::FilterLawCall<'_, Seeded> = &sees(0.8);
    let trial = laws::FilterLawTrial {
        estimate: &|filter: &Seeded| filter.0.particles().clone(),
        error: &error,
        bound: BOUND,
        accepted: &[good; 10],
        refused: &[&sees(f64::NAN), &sees(f64::MAX), &drives(f64::NAN, 0.0), &drives(0.0, f64::INFINITY)],
    };
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let filter = Problem::new(0.1, 0.3).bootstrap_filter(1000, &mut rng);
    laws::filter(&(filter, rng), &trial).unwrap();
}

#[test]
fn auxiliary_filter_obeys_the_laws_of_filters() {
    type Seeded = (Auxiliary, ChaCha8Rng);
    let steps = |z: f64| move |(filter, rng): &mut Seeded| filter.step(&None, &Vector1::new(z), rng).is_ok();
    let good: laws::FilterLawCall<'_, Seeded> = &steps(0.8);
    let trial = laws::FilterLawTrial {
        estimate: &|filter: &Seeded| filter.0.particles().clone(),
        error: &error,
        bound: BOUND,
        accepted: &[good; 10],
        refused: &[&steps(f64::NAN), &steps(f64::MAX)],
    };
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let filter = Problem::new(0.1, 0.3).auxiliary_filter(1000, &mut rng);
    laws::filter(&(filter, rng), &trial).unwrap();
}

#[test]
fn refusals_say_why() {
    let problem = Problem::new(0.1, 0.3);
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let mut bootstrap = problem.bootstrap_filter(10, &mut rng);
    let particles = bootstrap.particles().clone();
    let lost = Some(Vector2::new(f64::NAN, 0.0));
    assert_eq!(bootstrap.predict(&lost, &mut rng), Err(ParticleError::State { index: 0 }));
    let impossible = Vector1::new(f64::MAX);
    assert_eq!(bootstrap.update(&impossible), Err(ParticleError::NoWeight { count: 10 }));
    assert_eq!(bootstrap.particles(), &particles);
    let mut auxiliary = problem.auxiliary_filter(10, &mut rng);
    let particles = auxiliary.particles().clone();
    let refused: Result<NormalizationReport, _> = auxiliary.step(&None, &impossible, &mut rng);
    assert_eq!(refused, Err(ParticleError::NoWeight { count: 10 }));
    assert_eq!(auxiliary.particles(), &particles);
}
