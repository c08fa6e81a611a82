//! A target that switches: the filters know when, and are better for it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use crate::common::{TrackSensor, constant_velocity, position_sensor, track_prior};
use approx::assert_abs_diff_eq;
use nalgebra::{DefaultAllocator, Matrix1, Matrix3, U4, Vector1, Vector2, Vector3, Vector4};
use rand::SeedableRng;
use rand::distr::Distribution;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Manifold, MotionModel, Pose2, SensorModel, StateAlloc};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, FilterBank, Gpb2Filter, ImmFilter, InformationFilterAlgorithm,
    IteratedExtendedKalmanAlgorithm, JumpMarkovFilter, JumpMarkovFilterParams, KalmanAlgorithm, KalmanFilter,
    LinearMotion, LinearSensor, MarkovChain, SquareRootKalmanAlgorithm, UnscentedKalmanAlgorithm,
};

const SEEDS: std::ops::Range<u64> = 700..740;
const STEPS: usize = 200;
const QUIET: f64 = 1e-4;
const LIVELY: f64 = 20.0;
const SENSOR_VARIANCE: f64 = 0.25;

struct Scene {
    states: Vec<Vector4<f64>>,
    measurements: Vec<Vector2<f64>>,
}

/// Quiet for 50 steps, lively for 50, twice: drawn from the two motion models themselves.
fn scene(seed: u64) -> Scene {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut state = Vector4::new(0.0, 0.0, 1.0, 0.5);
    let (mut states, mut measurements) = (vec![], vec![]);
    for k in 0..STEPS {
        let motion = constant_velocity(if is_lively(k) { LIVELY } else { QUIET });
        let noise = Gaussian::from_parts_unchecked(Vector4::zeros(), *motion.noise());
        state = motion.transition() * state + noise.sample(&mut rng);
        let sensor_noise =
            Gaussian::from_sigmas(Vector2::zeros(), &Vector2::repeat(SENSOR_VARIANCE.sqrt())).unwrap();
        states.push(state);
        measurements.push(state.xy() + sensor_noise.sample(&mut rng));
    }
    Scene { states, measurements }
}

fn is_lively(step: usize) -> bool {
    (step / 50) % 2 == 1
}

fn models() -> Vec<LinearMotion<f64, U4>> {
    vec![constant_velocity(QUIET), constant_velocity(LIVELY)]
}

fn chain() -> MarkovChain {
    MarkovChain::sticky(2, 0.98).unwrap()
}

fn sensor() -> TrackSensor<f64> {
    position_sensor(SENSOR_VARIANCE)
}

/// What a filter made of a scene: mean squared position error, and the share of steps at which it named the model in force, leaving out
/// ten steps after each switch, when it cannot know yet.
struct Outcome {
    squared_error: f64,
    right_model: f64,
}

fn judge(scene: &Scene, mut step: impl FnMut(&Vector2<f64>) -> (Vector4<f64>, Vec<f64>)) -> Outcome {
    let (mut squared_error, mut right, mut settled) = (0.0, 0, 0);
    for (k, (truth, z)) in scene.states.iter().zip(&scene.measurements).enumerate() {
        let (mean, probabilities) = step(z);
        squared_error += (mean.xy() - truth.xy()).norm_squared() / STEPS as f64;
        if k % 50 >= 10 {
            settled += 1;
            right += usize::from((probabilities[1] > 0.5) == is_lively(k));
        }
    }
    Outcome { squared_error, right_model: right as f64 / settled as f64 }
}

fn single(scene: &Scene, q: f64) -> f64 {
    let mut filter = KalmanFilter::new(constant_velocity(q), track_prior(4.0)).unwrap();
    let outcome = judge(scene, |z| {
        filter.predict(None).unwrap();
        filter.update(&sensor(), z).unwrap();
        (*filter.estimate().mean(), vec![1.0, 0.0])
    });
    outcome.squared_error
}

fn imm<F: KalmanAlgorithm<Vector4<f64>>>(scene: &Scene, form: F) -> Outcome {
    let mut filter = ImmFilter::new(models(), chain(), form, &track_prior(4.0)).unwrap();
    judge(scene, |z| {
        filter.predict(&None).unwrap();
        filter.update(&sensor(), z).unwrap();
        (*filter.estimate().unwrap().mean(), filter.model_probabilities())
    })
}

fn gpb2<F: KalmanAlgorithm<Vector4<f64>>>(scene: &Scene, form: F) -> Outcome {
    let mut filter = Gpb2Filter::new(models(), chain(), form, &track_prior(4.0)).unwrap();
    judge(scene, |z| {
        filter.predict(&None).unwrap();
        filter.update(&sensor(), z).unwrap();
        (*filter.estimate().unwrap().mean(), filter.model_probabilities())
    })
}

/// The 95 % interval of a mean over seeds, by the normal approximation (40 seeds).
fn interval(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let half = 1.96 * (variance / n).sqrt();
    (mean - half, mean + half)
}

/// `switching` beats both single filters (the interval of the paired gain is above zero) and names the right model.
fn beats_either_alone(name: &str, switching: impl Fn(&Scene) -> Outcome) {
    let (mut over_quiet, mut over_lively, mut right) = (vec![], vec![], vec![]);
    for seed in SEEDS {
        let scene = scene(seed);
        let outcome = switching(&scene);
        over_quiet.push(single(&scene, QUIET) - outcome.squared_error);
        over_lively.push(single(&scene, LIVELY) - outcome.squared_error);
        right.push(outcome.right_model);
    }
    let (quiet, lively, right) = (interval(&over_quiet), interval(&over_lively), interval(&right));
    println!("{name}: gain over quiet {quiet:?} m², over lively {lively:?} m², right model {right:?}");
    assert!(quiet.0 > 0.0, "{name} against the quiet filter alone: {quiet:?}");
    assert!(lively.0 > 0.0, "{name} against the lively filter alone: {lively:?}");
    // Blind guessing names the right model half the time.
    assert!(right.0 > 0.5, "{name} names the right model {right:?} of the time");
}

#[test]
fn the_imm_follows_the_switches_in_every_form() {
    beats_either_alone("IMM extended", |scene| imm(scene, ExtendedKalmanAlgorithm));
    beats_either_alone("IMM unscented", |scene| imm(scene, UnscentedKalmanAlgorithm::default()));
    beats_either_alone("IMM square root", |scene| imm(scene, SquareRootKalmanAlgorithm));
    beats_either_alone("IMM information", |scene| imm(scene, InformationFilterAlgorithm));
}

#[test]
fn gpb2_follows_the_switches_in_every_form() {
    beats_either_alone("GPB2 extended", |scene| gpb2(scene, ExtendedKalmanAlgorithm));
    beats_either_alone("GPB2 iterated", |scene| gpb2(scene, IteratedExtendedKalmanAlgorithm::default()));
    beats_either_alone("GPB2 square root", |scene| gpb2(scene, SquareRootKalmanAlgorithm));
}

#[test]
fn with_one_model_both_are_the_kalman_filter() {
    let scene = scene(SEEDS.start);
    let one = || MarkovChain::sticky(1, 1.0).unwrap();
    let mut plain = KalmanFilter::new(constant_velocity(1.0), track_prior(4.0)).unwrap();
    let mut imm =
        ImmFilter::new(vec![constant_velocity(1.0)], one(), ExtendedKalmanAlgorithm, &track_prior(4.0))
            .unwrap();
    let mut gpb2 =
        Gpb2Filter::new(vec![constant_velocity(1.0)], one(), ExtendedKalmanAlgorithm, &track_prior(4.0))
            .unwrap();
    for z in &scene.measurements {
        plain.predict(None).unwrap();
        imm.predict(&None).unwrap();
        gpb2.predict(&None).unwrap();
        plain.update(&sensor(), z).unwrap();
        imm.update(&sensor(), z).unwrap();
        gpb2.update(&sensor(), z).unwrap();
        // One component's moments are its own, up to the rounding of weights that sum to one.
        for other in [imm.estimate().unwrap(), gpb2.estimate().unwrap()] {
            assert_abs_diff_eq!(
                other.mean(),
                plain.estimate().mean(),
                epsilon = 1e-12 * plain.estimate().mean().norm()
            );
            assert_abs_diff_eq!(other.covariance(), plain.estimate().covariance(), epsilon = 1e-12);
        }
    }
}

/// Two steps with two models have few histories: enumerate them all with plain Kalman filters and Bayes' rule. GPB2 is exact there.
#[test]
fn gpb2_is_exact_over_two_steps() {
    let (chain, measurements) =
        (MarkovChain::sticky(2, 0.9).unwrap(), [Vector2::new(0.4, -0.1), Vector2::new(1.5, 0.8)]);
    let mut filter =
        Gpb2Filter::new(models(), chain.clone(), ExtendedKalmanAlgorithm, &track_prior(4.0)).unwrap();
    for z in &measurements {
        filter.predict(&None).unwrap();
        filter.update(&sensor(), z).unwrap();
    }
    let mut weights = [0.0; 2];
    let (mut mean, mut total) = (Vector4::zeros(), 0.0);
    for start in 0..2 {
        for first in 0..2 {
            for (second, total_of_second) in weights.iter_mut().enumerate() {
                let mut plain = KalmanFilter::new(models()[first].clone(), track_prior(4.0)).unwrap();
                plain.predict(None).unwrap();
                let mut log = plain.update(&sensor(), &measurements[0]).unwrap().log_likelihood();
                let mut plain =
                    KalmanFilter::new(models()[second].clone(), plain.estimate().clone()).unwrap();
                plain.predict(None).unwrap();
                log += plain.update(&sensor(), &measurements[1]).unwrap().log_likelihood();
                let weight =
                    0.5 * chain.probability(start, first) * chain.probability(first, second) * log.exp();
                *total_of_second += weight;
                mean += plain.estimate().mean() * weight;
                total += weight;
            }
        }
    }
    // All hypotheses start from one Gaussian, so what is merged after the first step is equal and nothing is lost by merging.
    for (model, weight) in weights.iter().enumerate() {
        assert_abs_diff_eq!(filter.model_probabilities()[model], weight / total, epsilon = 1e-12);
    }
    assert_abs_diff_eq!(*filter.estimate().unwrap().mean(), mean / total, epsilon = 1e-12 * 10.0);
}

/// A planar robot that drives straight or turns.
#[derive(Clone)]
struct Turning(f64);

impl MotionModel for Turning {
    type State = Pose2<f64>;
    type Control = f64;
    fn propagate(&self, pose: &Pose2<f64>, distance: &f64) -> Pose2<f64> {
        pose.retract(&Vector3::new(*distance, 0.0, self.0))
    }
    fn noise(&self, _: &Pose2<f64>, _: &f64) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1e-5))
    }
}

struct Fix;

impl SensorModel for Fix {
    type State = Pose2<f64>;
    type Measurement = Vector2<f64>;
    fn expected(&self, pose: &Pose2<f64>) -> Vector2<f64> {
        pose.translation
    }
    fn noise(&self, _: &Pose2<f64>) -> nalgebra::Matrix2<f64> {
        nalgebra::Matrix2::identity() * 1e-3
    }
}

#[test]
fn poses_switch_too_and_their_headings_wrap() {
    fn run<F: KalmanAlgorithm<Pose2<f64>>>(form: F) -> (Gaussian<Pose2<f64>>, Vec<f64>, Pose2<f64>)
    where
        DefaultAllocator: StateAlloc<nalgebra::U3>,
    {
        let prior = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 3.0), &Vector3::new(0.1, 0.1, 0.1)).unwrap();
        let mut filter = ImmFilter::new(
            vec![Turning(0.0), Turning(0.1)],
            MarkovChain::sticky(2, 0.9).unwrap(),
            form,
            &prior,
        )
        .unwrap();
        let mut truth = Pose2::new(0.05, -0.05, 3.05);
        for k in 0..60 {
            truth = Turning(if k < 30 { 0.0 } else { 0.1 }).propagate(&truth, &0.5);
            filter.predict(&0.5).unwrap();
            filter.update(&Fix, &truth.translation).unwrap();
        }
        (filter.estimate().unwrap(), filter.model_probabilities(), truth)
    }
    for (estimate, probabilities, truth) in [
        run(ExtendedKalmanAlgorithm),
        run(UnscentedKalmanAlgorithm::default()),
        run(SquareRootKalmanAlgorithm),
    ] {
        // Both models were equally probable at the start; 30 steps of turning must have told them apart.
        assert!(probabilities[1] > 0.5, "turning for 30 steps: {probabilities:?}");
        let error = estimate.mean().local(&truth);
        let sigmas = estimate.sigmas();
        // Noise-free measurements: the error stays inside what the filter itself allows.
        assert!((0..3).all(|i| error[i].abs() < 3.0 * sigmas[i]), "error {error}, sigmas {sigmas}");
    }
}

/// Two lights, 160 and 40; each filter drifts slowly.
fn lights(n_histories: usize) -> JumpMarkovFilter<LinearMotion<f64, nalgebra::U1>, ExtendedKalmanAlgorithm> {
    let drift = LinearMotion::stationary(Matrix1::new(0.5)).unwrap();
    let prior = |mean: f64| Gaussian::new(Vector1::new(mean), Matrix1::new(400.0)).unwrap();
    let bank =
        FilterBank::new(vec![drift.clone(), drift], ExtendedKalmanAlgorithm, &[prior(160.0), prior(40.0)])
            .unwrap();
    let params = JumpMarkovFilterParams { n_histories, n_recorded_models: 40 };
    JumpMarkovFilter::new(bank, MarkovChain::sticky(2, 0.95).unwrap(), params).unwrap()
}

fn light_sensor() -> LinearSensor<Vector1<f64>, Vector1<f64>> {
    LinearSensor::new(Matrix1::new(1.0), Matrix1::new(25.0)).unwrap()
}

#[test]
fn active_light_is_selected_and_the_other_is_unchanged() {
    for n_histories in [1, 8] {
        let mut light = lights(n_histories);
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let noise = Gaussian::new(Vector1::new(0.0), Matrix1::new(25.0)).unwrap();
        let mut untouched = light.bank().last_active_estimate(1);
        for k in 0..120 {
            let dark = (30..60).contains(&k) || k >= 90;
            light.predict(&None).unwrap();
            // Every fifth image shows no colour.
            let seen =
                (k % 5 != 4).then(|| Vector1::new(if dark { 52.0 } else { 148.0 }) + noise.sample(&mut rng));
            light.update(&light_sensor(), seen.as_ref()).unwrap();
            assert_eq!(light.selected(), usize::from(dark), "step {k}");
            if !dark && k < 30 {
                assert_eq!(
                    light.bank().last_active_estimate(1),
                    untouched,
                    "step {k} touched the filter that was off"
                );
            } else {
                untouched = light.bank().last_active_estimate(1);
            }
        }
        // 25 over some 48 measurements of each light, plus drift: sigma below 2.5; four of them.
        assert_abs_diff_eq!(light.estimate().mean()[0], 52.0, epsilon = 10.0);
        assert_abs_diff_eq!(light.bank().last_active_estimate(0).unwrap().mean()[0], 148.0, epsilon = 10.0);
        assert_eq!(light.most_probable_history().len(), 40);
        assert!(light.log_evidence()[1] > light.log_evidence()[0]);
    }
}

/// With room for all of them the histories are the exact posterior: compare with enumeration by hand.
#[test]
fn all_histories_kept_are_the_exact_posterior() {
    let measurements = [100.0, 90.0, 110.0];
    let mut light = lights(1 << measurements.len());
    for z in measurements {
        light.predict(&None).unwrap();
        light.update(&light_sensor(), Some(&Vector1::new(z))).unwrap();
    }
    let chain = MarkovChain::sticky(2, 0.95).unwrap();
    let (mut last, mut best) = ([0.0; 2], (0.0, vec![]));
    for code in 0..8_usize {
        let path: Vec<usize> = (0..3).map(|k| (code >> k) & 1).collect();
        let mut bank = [(160.0, 400.0), (40.0, 400.0)];
        let mut weight = 1.0;
        let mut before = None;
        for (&model, z) in path.iter().zip(measurements) {
            weight *= before.map_or(0.5, |before| chain.probability(before, model));
            before = Some(model);
            let (mean, variance) = bank[model];
            let predicted = variance + 0.5;
            let s: f64 = predicted + 25.0;
            let y: f64 = z - mean;
            weight *= (-0.5 * y * y / s).exp() / (std::f64::consts::TAU * s).sqrt();
            let gain = predicted / s;
            bank[model] = (mean + gain * y, (1.0 - gain) * predicted);
        }
        last[path[2]] += weight;
        if weight > best.0 {
            best = (weight, path);
        }
    }
    let total = last[0] + last[1];
    for (found, weight) in light.model_probabilities().iter().zip(last) {
        assert_abs_diff_eq!(*found, weight / total, epsilon = 1e-12);
    }
    assert_eq!(light.most_probable_history(), best.1);
}

#[test]
fn refused_calls_leave_switching_filters_as_they_were() {
    let bad = Vector2::new(f64::NAN, 0.0);
    let mut imm = ImmFilter::new(models(), chain(), ExtendedKalmanAlgorithm, &track_prior(4.0)).unwrap();
    let mut gpb2 = Gpb2Filter::new(models(), chain(), ExtendedKalmanAlgorithm, &track_prior(4.0)).unwrap();
    imm.predict(&None).unwrap();
    gpb2.predict(&None).unwrap();
    let (before_imm, before_gpb2) = (imm.estimate().unwrap(), gpb2.estimate().unwrap());
    let nan = Some(Vector4::repeat(f64::NAN));
    assert!(imm.update(&sensor(), &bad).is_err() && imm.predict(&nan).is_err());
    assert!(gpb2.update(&sensor(), &bad).is_err() && gpb2.predict(&nan).is_err());
    assert_eq!((imm.estimate().unwrap(), gpb2.estimate().unwrap()), (before_imm, before_gpb2));
    let mut light = lights(4);
    light.predict(&None).unwrap();
    let before = (light.estimate(), light.model_probabilities());
    assert!(light.update(&light_sensor(), Some(&Vector1::new(f64::INFINITY))).is_err());
    assert!(light.predict(&Some(Vector1::new(f64::NAN))).is_err());
    assert_eq!((light.estimate(), light.model_probabilities()), before);
}
