use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::GaitOdometryParams;
use crate::random::GaussMarkovProcess;
use crate::random::deviate::uniform;

/// Odometry from commanded steps.
#[derive(Clone, Debug)]
pub(super) struct GaitOdometry {
    params: GaitOdometryParams,
    /// Share of a command that becomes motion: forwards, sideways, turning.
    scales: [f64; 3],
    drift: GaussMarkovProcess,
    /// True motion since the last increment, summed in the moving frame.
    moved: [f64; 3],
}

impl GaitOdometry {
    pub(super) fn new<R: Rng + ?Sized>(params: GaitOdometryParams, rng: &mut R) -> Self {
        let [step, turn] = [params.step_scale_range, params.turn_scale_range];
        let scales = [step, step, turn].map(|[low, high]| uniform(low, high, rng));
        Self { params, scales, drift: GaussMarkovProcess::new(params.drift_correlation_s), moved: [0.0; 3] }
    }

    pub(super) fn add(&mut self, moved: &Pose2<f64>) {
        let moved = [moved.x(), moved.y(), moved.heading()];
        self.moved.iter_mut().zip(moved).for_each(|(sum, part)| *sum += part);
    }

    pub(super) fn take<R: Rng + ?Sized>(&mut self, seconds: f64, rng: &mut R) -> Pose2<f64> {
        let [x, y, turn] = self.moved;
        let drift = self.params.drift_sigma_rad_per_m * self.drift.advance(seconds, rng) * libm::hypot(x, y);
        let truth = [x, y, turn + drift];
        self.moved = [0.0; 3];
        let mut said = [0.0; 3];
        for ((said, truth), scale) in said.iter_mut().zip(truth).zip(self.scales) {
            *said = truth / scale * (1.0 + self.params.noise * self.params.noise_shape.draw(rng));
        }
        Pose2::new(said[0], said[1], said[2])
    }
}
