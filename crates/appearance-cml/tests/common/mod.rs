//! A world without images: what is seen at a point is a random field, rough like real views.

use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};
use wayfix_appearance_cml::{Comparison, Descriptor};
use wayfix_estimation_traits::{Pose2, wrap_angle};

/// Features of a view; the heading stands for the phase of a panorama.
#[derive(Clone, Debug)]
pub struct FieldView {
    features: Vec<f64>,
    heading: f64,
}

impl Descriptor for FieldView {
    fn compare(&self, reference: &Self) -> Comparison {
        let squared: f64 = self.features.iter().zip(&reference.features).map(|(a, b)| (a - b).powi(2)).sum();
        Comparison {
            distance: (squared / self.features.len() as f64).sqrt(),
            rotation: wrap_angle(self.heading - reference.heading),
        }
    }
}

/// Features as sums of plane waves of all lengths between those given.
pub struct Field {
    waves: Vec<Vec<[f64; 4]>>,
}

const FEATURES: usize = 32;
const WAVES: usize = 12;

impl Field {
    /// A world of its own for each state of the generator; wavelengths in metres.
    pub fn new<R: Rng + ?Sized>(shortest: f64, longest: f64, rng: &mut R) -> Self {
        let wave = |rng: &mut R| {
            let length = shortest * (longest / shortest).powf(rng.random::<f64>());
            let direction = std::f64::consts::TAU * rng.random::<f64>();
            let number = std::f64::consts::TAU / length;
            // Long waves are high: amplitudes fall as in natural images.
            let amplitude = (length / longest).sqrt();
            [
                number * direction.cos(),
                number * direction.sin(),
                std::f64::consts::TAU * rng.random::<f64>(),
                amplitude,
            ]
        };
        let waves = (0..FEATURES).map(|_| (0..WAVES).map(|_| wave(rng)).collect()).collect();
        Self { waves }
    }

    /// What is seen from a pose, with noise of this σ on each feature and 0.02 rad on the phase.
    pub fn view<R: Rng + ?Sized>(&self, pose: &Pose2<f64>, noise: f64, rng: &mut R) -> FieldView {
        let feature = |waves: &Vec<[f64; 4]>| -> f64 {
            waves
                .iter()
                .map(|[kx, ky, phase, amplitude]| amplitude * (kx * pose.x() + ky * pose.y() + phase).sin())
                .sum()
        };
        let features = self.waves.iter().map(|waves| feature(waves) + noise * normal(rng)).collect();
        FieldView { features, heading: wrap_angle(pose.heading() + 0.02 * normal(rng)) }
    }
}

/// A standard normal number.
pub fn normal<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    StandardNormal.sample(rng)
}

/// Odometry that has drifted: a step scaled and turned a little, with noise that grows with the way.
pub fn drifting<R: Rng + ?Sized>(step: &Pose2<f64>, rng: &mut R) -> Pose2<f64> {
    let way = step.translation.norm();
    Pose2::new(
        step.x() * 1.02 + 0.02 * way.sqrt() * normal(rng),
        step.y() + 0.01 * way.sqrt() * normal(rng),
        step.heading() * 1.02 + 0.01 * way.sqrt() * normal(rng),
    )
}

/// Poses along a closed way: the corners of a rectangle rounded off, `steps` to a lap.
pub fn lap(width: f64, height: f64, steps: usize) -> Vec<Pose2<f64>> {
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / steps as f64;
        // A superellipse of fourth degree.
        let round = |v: f64| v.signum() * v.abs().sqrt();
        [0.5 * width * round(angle.cos()), 0.5 * height * round(angle.sin())]
    };
    let pose = |k: usize| {
        let ([x, y], [ahead_x, ahead_y]) = (at(k), at(k + 1));
        Pose2::new(x, y, (ahead_y - y).atan2(ahead_x - x))
    };
    (0..steps).map(pose).collect()
}
