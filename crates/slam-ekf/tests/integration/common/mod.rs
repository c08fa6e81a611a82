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
        Step { truth, increment, observations: look(&truth, landmarks, RANGE, SIGHTING, rng) }
    };
    (0..n_steps).map(&mut step).collect()
}

pub(crate) fn start() -> Pose2<f64> {
    start_at(LAP_RADIUS)
}

pub(crate) fn start_at(radius: f64) -> Pose2<f64> {
    Pose2::new(radius, 0.0, std::f64::consts::FRAC_PI_2)
}

/// Laps of a circle in a ring of landmarks.
pub(crate) struct LongLoop {
    pub(crate) radius: f64,
    pub(crate) n_per_lap: usize,
    pub(crate) odometry: [f64; 3],
    pub(crate) sighting: [f64; 2],
}

impl LongLoop {
    pub(crate) fn start(&self) -> Pose2<f64> {
        Pose2::new(self.radius, 0.0, std::f64::consts::FRAC_PI_2)
    }

    /// In the order of their directions from the centre, up to 8 m from the path.
    pub(crate) fn landmarks(&self, n: usize, rng: &mut ChaCha8Rng) -> Vec<[f64; 2]> {
        let place = |i: usize| {
            let angle = std::f64::consts::TAU * (i as f64 + rng.random::<f64>()) / n as f64;
            let radius = self.radius + 8.0 * (2.0 * rng.random::<f64>() - 1.0);
            [radius * angle.cos(), radius * angle.sin()]
        };
        (0..n).map(place).collect()
    }

    pub(crate) fn drive(&self, n_steps: usize, landmarks: &[[f64; 2]], rng: &mut ChaCha8Rng) -> Vec<Step> {
        let turn = std::f64::consts::TAU / self.n_per_lap as f64;
        let motion = Pose2::exp(&nalgebra::Vector3::new(self.radius * turn, 0.0, turn));
        let mut truth = self.start();
        let step = |_| {
            truth = truth.compose(&motion);
            let [x, y, turn] = self.odometry.map(|sigma| sigma * normal(rng));
            let increment = Pose2::new(motion.x() + x, motion.y() + y, motion.heading() + turn);
            Step { truth, increment, observations: look(&truth, landmarks, 10.0, self.sighting, rng) }
        };
        (0..n_steps).map(step).collect()
    }
}

/// Everything within `reach`, with its identity.
fn look(
    robot: &Pose2<f64>,
    landmarks: &[[f64; 2]],
    reach: f64,
    sigmas: [f64; 2],
    rng: &mut ChaCha8Rng,
) -> Vec<Observation<RangeBearing>> {
    let see = |(id, [x, y]): (usize, &[f64; 2])| {
        let seen = robot.inverse_transform(&nalgebra::Vector2::new(*x, *y));
        let [range, bearing] = sigmas.map(|sigma| sigma * normal(rng));
        let measurement = RangeBearing::new(seen.norm() + range, seen.y.atan2(seen.x) + bearing);
        (seen.norm() < reach).then_some(Observation { label: Some(LandmarkId(id as u32)), measurement })
    };
    landmarks.iter().enumerate().filter_map(see).collect()
}
