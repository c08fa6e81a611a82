//! A world without images: what is seen at a point is a random field, rough like real views.

use nalgebra::Vector3;
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};
use wayfix_appearance_cml::{ViewDescriptor, ViewDifference};
use wayfix_estimation_traits::{LieGroup, Pose2, wrap_angle};
use wayfix_gaussian_core::Gaussian;

/// Features of a view; the heading stands for the phase of a panorama.
#[derive(Clone, Debug)]
pub(crate) struct FieldView {
    features: Vec<f64>,
    heading: f64,
}

impl ViewDescriptor for FieldView {
    fn compare(&self, reference: &Self) -> ViewDifference {
        let squared: f64 = self.features.iter().zip(&reference.features).map(|(a, b)| (a - b).powi(2)).sum();
        ViewDifference {
            distance: (squared / self.features.len() as f64).sqrt(),
            rotation: wrap_angle(self.heading - reference.heading),
        }
    }
}

/// Features as sums of plane waves, alike over about half a metre and strange to one another from two on.
pub(crate) struct Field {
    waves: Vec<Vec<[f64; 3]>>,
}

const FEATURES: usize = 32;
const WAVES: usize = 8;
/// Wavelengths, m.
const LENGTHS: [f64; 2] = [2.0, 8.0];

impl Field {
    /// A world of its own for each state of the generator.
    pub(crate) fn new<R: Rng + ?Sized>(rng: &mut R) -> Self {
        let wave = |rng: &mut R| {
            let length = LENGTHS[0] * (LENGTHS[1] / LENGTHS[0]).powf(rng.random::<f64>());
            let direction = std::f64::consts::TAU * rng.random::<f64>();
            let number = std::f64::consts::TAU / length;
            [number * direction.cos(), number * direction.sin(), std::f64::consts::TAU * rng.random::<f64>()]
        };
        let waves = (0..FEATURES).map(|_| (0..WAVES).map(|_| wave(rng)).collect()).collect();
        Self { waves }
    }

    /// What is seen from a pose, with noise on each feature and 0.02 rad on the phase.
    pub(crate) fn view<R: Rng + ?Sized>(&self, pose: &Pose2<f64>, rng: &mut R) -> FieldView {
        let feature = |waves: &Vec<[f64; 3]>| -> f64 {
            waves.iter().map(|[kx, ky, phase]| (kx * pose.x() + ky * pose.y() + phase).sin()).sum()
        };
        let features = self.waves.iter().map(|waves| feature(waves) + 0.3 * normal(rng)).collect();
        FieldView { features, heading: wrap_angle(pose.heading() + 0.02 * normal(rng)) }
    }

    /// Somebody stands before the camera.
    pub(crate) fn occluded<R: Rng + ?Sized>(&self, rng: &mut R) -> FieldView {
        FieldView { features: (0..FEATURES).map(|_| 2.0 * normal(rng)).collect(), heading: 0.0 }
    }
}

/// A standard normal number.
pub(crate) fn normal<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    StandardNormal.sample(rng)
}

/// What odometry says of a step: a scale and a turn that are off, and noise that grows with the way.
pub(crate) fn drifting<R: Rng + ?Sized>(step: &Pose2<f64>, rng: &mut R) -> Pose2<f64> {
    let way = step.translation.norm();
    Pose2::new(
        step.x() * 1.01 + 0.01 * way.sqrt() * normal(rng),
        step.y() + 0.01 * way.sqrt() * normal(rng),
        step.heading() + 0.002 * way + 0.005 * way.sqrt() * normal(rng),
    )
}

/// Steps of a way once round, about 0.26 m each.
pub(crate) const N_STEPS: usize = 160;

/// Where the robot is at a step when it drives so far beside the lane that was taught, m.
pub(crate) fn beside(step: usize, offset: f64) -> Pose2<f64> {
    lap(14.0, 8.0, N_STEPS)[step % N_STEPS].compose(&Pose2::new(0.0, offset, 0.0))
}

/// Poses along a closed way, a rectangle with round corners.
pub(crate) fn lap(width: f64, height: f64, steps: usize) -> Vec<Pose2<f64>> {
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / steps as f64;
        // A superellipse of third degree.
        let round = |v: f64| v.signum() * v.abs().powf(2.0 / 3.0);
        [0.5 * width * round(angle.cos()), 0.5 * height * round(angle.sin())]
    };
    let pose = |k: usize| {
        let ([x, y], [ahead_x, ahead_y]) = (at(k), at(k + 1));
        Pose2::new(x, y, (ahead_y - y).atan2(ahead_x - x))
    };
    (0..steps).map(pose).collect()
}

/// The motion from one pose to another.
pub(crate) fn between(from: &Pose2<f64>, to: &Pose2<f64>) -> Pose2<f64> {
    from.inverse().compose(to)
}

/// A pose that was surveyed: known to 2 cm and 0.01 rad.
pub(crate) fn known(pose: Pose2<f64>) -> Gaussian<Pose2<f64>> {
    Gaussian::from_sigmas(pose, &Vector3::new(0.02, 0.02, 0.01)).expect("sigmas are positive")
}
