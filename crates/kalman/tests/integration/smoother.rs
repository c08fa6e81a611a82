//! The Rauch-Tung-Striebel smoother is the batch least-squares fit.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use crate::common::{constant_velocity, position_sensor, track_prior};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2, Vector3};
use rand::SeedableRng;
use rand::distr::Distribution;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Manifold, MotionModel, Pose2, SensorModel};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::RtsSmoother;

/// The normal equations over the whole path, solved at once: an oracle without any recursion.
#[test]
fn smoothing_is_least_squares_over_the_whole_path() {
    const N: usize = 40;
    let (motion, sensor) = (constant_velocity(0.7), position_sensor(0.3));
    let measurement = |k: usize| Vector2::new((k as f64 * 0.3).sin(), (k as f64 * 0.2).cos());
    let seen = |k: usize| k > 0 && !k.is_multiple_of(3);
    let mut smoother = RtsSmoother::new(track_prior(2.0)).unwrap();
    for k in 1..=N {
        smoother.predict(&motion, &None).unwrap();
        if seen(k) {
            smoother.update(&sensor, &measurement(k)).unwrap();
        }
    }
    let size = 4 * (N + 1);
    let (mut information, mut pull) = (DMatrix::<f64>::zeros(size, size), DVector::<f64>::zeros(size));
    information.view_mut((0, 0), (4, 4)).copy_from(&(nalgebra::Matrix4::identity() / 2.0));
    let weight = motion.noise().try_inverse().unwrap();
    let f = motion.transition();
    for k in 1..=N {
        let (a, b) = (4 * (k - 1), 4 * k);
        let mut add = |row, column, block: nalgebra::Matrix4<f64>| {
            let mut view = information.view_mut((row, column), (4, 4));
            view += block;
        };
        add(a, a, f.transpose() * weight * f);
        add(a, b, -f.transpose() * weight);
        add(b, a, -weight * f);
        add(b, b, weight);
        if seen(k) {
            let h = sensor.matrix();
            add(b, b, h.transpose() * h / 0.3);
            let mut rows = pull.rows_mut(b, 4);
            rows += h.transpose() * measurement(k) / 0.3;
        }
    }
    let covariance = information.clone().try_inverse().unwrap();
    let fit = information.cholesky().unwrap().solve(&pull);
    // The normal equations have a condition number near 1e7 (inverse of the rank-poor motion noise against the prior): 1e7 roundings.
    let rounding = 1e7 * f64::EPSILON;
    for (k, smoothed) in smoother.smoothed().unwrap().iter().enumerate() {
        let block = covariance.view((4 * k, 4 * k), (4, 4));
        assert!((smoothed.mean() - fit.rows(4 * k, 4)).norm() < rounding * fit.norm(), "mean of state {k}");
        assert!((smoothed.covariance() - block).norm() < rounding * block.norm(), "covariance of state {k}");
    }
}

struct Odometry;
impl MotionModel for Odometry {
    type State = Pose2<f64>;
    type Control = Vector3<f64>;
    fn propagate(&self, pose: &Pose2<f64>, step: &Vector3<f64>) -> Pose2<f64> {
        pose.retract(step)
    }
    fn noise(&self, _: &Pose2<f64>, _: &Vector3<f64>) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 4e-4))
    }
}
struct Fix;
impl SensorModel for Fix {
    type State = Pose2<f64>;
    type Measurement = Vector2<f64>;
    fn expected(&self, pose: &Pose2<f64>) -> Vector2<f64> {
        pose.translation
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix2<f64> {
        Matrix2::identity() * 0.01
    }
}

/// Seeds 1..=30: on curved paths whose headings wrap, looking back halves the error or better and never reports more variance.
#[test]
fn smoothing_poses_improves_on_filtering() {
    let (mut filtered_error, mut smoothed_error) = (0.0, 0.0);
    for seed in 1..=30 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let prior = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 3.0), &Vector3::new(0.3, 0.3, 0.3)).unwrap();
        let step = Vector3::new(0.2, 0.0, 0.07);
        let motion_noise = Gaussian::new(Vector3::zeros(), Odometry.noise(prior.mean(), &step)).unwrap();
        let sensor_noise = Gaussian::new(Vector2::zeros(), Fix.noise(prior.mean())).unwrap();
        let mut truth = prior.sample(&mut rng);
        let mut smoother = RtsSmoother::new(prior.clone()).unwrap();
        let (mut truths, mut filtered) = (vec![truth], vec![prior]);
        for _ in 0..100 {
            truth = truth.retract(&step).retract(&motion_noise.sample(&mut rng));
            smoother.predict(&Odometry, &step).unwrap();
            smoother.update(&Fix, &(truth.translation + sensor_noise.sample(&mut rng))).unwrap();
            truths.push(truth);
            filtered.push(smoother.filtered().clone());
        }
        let smoothed = smoother.smoothed().unwrap();
        for ((truth, filtered), smoothed) in truths.iter().zip(&filtered).zip(&smoothed) {
            filtered_error += filtered.mean().local(truth).norm_squared();
            smoothed_error += smoothed.mean().local(truth).norm_squared();
            assert!(smoothed.covariance().trace() <= filtered.covariance().trace() * (1.0 + 1e-9));
        }
    }
    assert!(smoothed_error < 0.5 * filtered_error, "smoothed {smoothed_error}, filtered {filtered_error}");
}
