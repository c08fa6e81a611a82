//! The cart itself: where it really is, which no filter sees, what its wheels say and what its laser sees.

use nalgebra::{Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::warehouse;

/// Drives to one point after the other.
pub struct Cart {
    pose: Pose2<f64>,
    way: Vec<Vector2<f64>>,
    driven: f64,
    noise: Noise,
}

const STEP_M: f64 = 0.15;

impl Cart {
    /// Three laps round both shelves.
    pub fn new(start: Pose2<f64>) -> Self {
        let lap = [(13.2, 2.0), (13.2, 7.6), (2.4, 8.2), (2.0, 5.1), (13.0, 5.1), (13.2, 2.2), (2.0, 2.0)];
        let mut way: Vec<Vector2<f64>> = (0..3).flat_map(|_| lap).map(|(x, y)| Vector2::new(x, y)).collect();
        way.reverse();
        Self { pose: start, way, driven: 0.0, noise: Noise(0x9E37_79B9_7F4A_7C15) }
    }

    /// The truth, to judge by.
    pub fn pose(&self) -> &Pose2<f64> {
        &self.pose
    }

    /// Metres so far.
    pub fn driven(&self) -> f64 {
        self.driven
    }

    /// One step on the way; what the wheels say of it. `None` at the end.
    pub fn drive(&mut self) -> Option<Pose2<f64>> {
        let goal = loop {
            let goal = self.pose.inverse_transform(self.way.last()?);
            if goal.norm() > STEP_M {
                break goal;
            }
            self.way.pop();
        };
        let turn = goal.y.atan2(goal.x).clamp(-0.25, 0.25);
        let forward = if turn.abs() > 0.2 { 0.03 } else { STEP_M };
        let moved = Pose2::exp(&Vector3::new(forward, 0.0, turn));
        self.pose = self.pose.compose(&moved);
        self.driven += forward;
        // One wheel is a little larger, and the floor is not clean.
        let (slip, drift) = (0.02 * self.noise.next(), 0.012 * forward + 0.02 * turn * self.noise.next());
        Some(Pose2::exp(&Vector3::new(forward * (1.01 + slip), 0.0, turn + drift)))
    }

    /// A laser of half a turn, a beam every half degree, with a centimetre of noise; no echo is infinite.
    pub fn scan(&mut self) -> Vec<f64> {
        let beam = |k: i32| {
            let (sin, cos) = (f64::from(k - 180) * 0.5_f64.to_radians() + self.pose.heading()).sin_cos();
            let range = warehouse::range(&self.pose.translation, &Vector2::new(cos, sin));
            range.map_or(f64::INFINITY, |range| range + 0.01 * self.noise.next())
        };
        (0..=360).map(beam).collect()
    }
}

/// Numbers of mean 0 and variance 1 from twelve uniform ones: a robot of its own needs no library for that.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let sum: f64 = (0..12).map(|_| self.uniform()).sum();
        sum - 6.0
    }

    /// Marsaglia's xorshift.
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
