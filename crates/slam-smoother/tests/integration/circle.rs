//! A robot that drives round a circle among landmarks.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_smoother::points::{
    Detection, PointMapGaussian, PointSmoother, PointSmootherParams, SettledPose,
};

pub(crate) const MOUNT: [f64; 3] = [0.4, -0.1, 0.7];

pub(crate) fn params(lag: Option<f64>) -> PointSmootherParams {
    let [x, y, heading] = MOUNT;
    PointSmootherParams { lag, period: 1.0, mount: Pose2::new(x, y, heading), pairs_anew: false }
}

pub(crate) fn start() -> PointMapGaussian {
    PointMapGaussian::without_landmarks(Pose2::identity(), &Matrix3::zeros(), 0.03)
}

pub(crate) struct Step {
    pub(crate) motion: Pose2<f64>,
    pub(crate) seen: Vec<(u32, Detection)>,
}

/// A second a step, round a circle, among landmarks.
pub(crate) fn steps(n: usize) -> (Vec<Step>, Vec<Pose2<f64>>) {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut noise = |sigma: f64| Normal::new(0.0, sigma).unwrap().sample(&mut rng);
    let landmarks: Vec<_> =
        (0..8).map(|k| Vector2::new(2.0 + 4.0 * (k as f64).cos(), 3.0 + 5.0 * (k as f64).sin())).collect();
    let (mut truth, mut steps) = (vec![Pose2::identity()], Vec::new());
    let step = Pose2::new(0.5, 0.0, 0.15);
    for k in 0..n {
        let robot = truth[k].compose(&step);
        truth.push(robot);
        let motion = step.compose(&Pose2::exp(&Vector3::new(noise(0.02), noise(0.02), noise(0.01))));
        let [x, y, heading] = MOUNT;
        let sensor = robot.compose(&Pose2::new(x, y, heading));
        let seen = landmarks.iter().enumerate().filter(|(id, _)| (id + k) % 3 == 0);
        let seen = seen.map(|(id, landmark)| {
            let seen = sensor.inverse_transform(landmark);
            let covariance = Matrix2::new(0.0025, 0.0, 0.0, 0.0004);
            let (range, bearing) = (1.02 * seen.norm() + noise(0.05), seen.y.atan2(seen.x) + noise(0.02));
            (id as u32, Detection { range, bearing, covariance })
        });
        steps.push(Step { motion, seen: seen.collect() });
    }
    (steps, truth)
}

pub(crate) fn noise() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(0.0004, 0.0004, 0.0001))
}

pub(crate) fn run(lag: Option<f64>, steps: &[Step]) -> (PointSmoother, Vec<SettledPose>) {
    let mut smoother = PointSmoother::new(params(lag), &start()).unwrap();
    let mut settled = Vec::new();
    for (k, step) in steps.iter().enumerate() {
        settled.extend(take(&mut smoother, k, step));
    }
    settled.extend(smoother.finish().unwrap());
    (smoother, settled)
}

pub(crate) fn take(smoother: &mut PointSmoother, k: usize, step: &Step) -> Vec<SettledPose> {
    smoother.advance(step.motion, &noise(), None).unwrap();
    for (landmark, detection) in &step.seen {
        smoother.detect(*landmark, detection).unwrap();
    }
    smoother.step(k as f64).unwrap()
}
