#![allow(dead_code, reason = "each test takes what it needs")]
//! A small world that knows nothing of the filter: a circle among points, with errors drawn here.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_ekf::{LandmarkId, Observation, RangeBearing};

/// Standard deviations of odometry per step and of sightings.
pub(crate) const ODOMETRY: [f64; 3] = [0.02, 0.02, 0.005];
pub(crate) const SIGHTING: [f64; 2] = [0.05, 0.01];
const RANGE: f64 = 7.0;
const LAP_RADIUS: f64 = 3.0;

pub(crate) struct Step {
    pub(crate) truth: Pose2<f64>,
    pub(crate) increment: Pose2<f64>,
    pub(crate) observations: Vec<Observation<RangeBearing>>,
}

/// Box-Muller; the sum of twelve would do as well.
pub(crate) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// Landmarks on a jittered ring of 6 m around the origin.
pub(crate) fn landmarks(n: usize, rng: &mut ChaCha8Rng) -> Vec<[f64; 2]> {
    landmarks_around(LAP_RADIUS, n, rng)
}

/// Landmarks outside of a lap of this radius, one to five metres from it.
pub(crate) fn landmarks_around(lap_radius: f64, n: usize, rng: &mut ChaCha8Rng) -> Vec<[f64; 2]> {
    let place = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        let radius = lap_radius + 1.0 + 4.0 * rng.random::<f64>();
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..n).map(place).collect()
}

/// A drive on a circle of 3 m from (3, 0), in steps of a quarter of a metre.
pub(crate) fn drive(n_steps: usize, landmarks: &[[f64; 2]], rng: &mut ChaCha8Rng) -> Vec<Step> {
    drive_around(LAP_RADIUS, n_steps, landmarks, rng)
}

/// A drive on a circle of this radius, in steps of a quarter of a metre.
pub(crate) fn drive_around(
    radius: f64,
    n_steps: usize,
    landmarks: &[[f64; 2]],
    rng: &mut ChaCha8Rng,
) -> Vec<Step> {
    let motion = Pose2::new(0.25, 0.0, 0.25 / radius);
    let mut truth = start_at(radius);
    let mut step = |k: usize| {
        let mut increment = Pose2::new(0.0, 0.0, 0.0);
        if k > 0 {
            truth = truth.compose(&motion);
            let [x, y, turn] = ODOMETRY.map(|sigma| sigma * normal(rng));
            increment = Pose2::new(motion.x() + x, motion.y() + y, motion.heading() + turn);
        }
        let observations = landmarks.iter().enumerate().filter_map(|(id, [x, y])| {
            let seen = truth.inverse_transform(&nalgebra::Vector2::new(*x, *y));
            let [range, bearing] = SIGHTING.map(|sigma| sigma * normal(rng));
            let measurement = RangeBearing::new(seen.norm() + range, seen.y.atan2(seen.x) + bearing);
            (seen.norm() < RANGE).then_some(Observation { label: Some(LandmarkId(id as u32)), measurement })
        });
        let observations = observations.collect();
        Step { truth, increment, observations }
    };
    (0..n_steps).map(&mut step).collect()
}

pub(crate) fn start() -> Pose2<f64> {
    start_at(LAP_RADIUS)
}

pub(crate) fn start_at(radius: f64) -> Pose2<f64> {
    Pose2::new(radius, 0.0, std::f64::consts::FRAC_PI_2)
}
