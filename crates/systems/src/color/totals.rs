use std::time::Duration;

use wayfix_color_model::LocalizationStatus;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::{
    errors::{ReferencePath, RunningErrors, TruthQueue},
    report::Metric,
};
use wayfix_sensor_log::Stamp;

use super::{ColorFrameResult, ColorSystem};

/// Sums over all frames of a log, so that none need be kept.
#[derive(Clone, Debug, Default)]
pub(super) struct ColorTotals {
    n_frames: usize,
    effective_particles: f64,
    n_particles: f64,
    milliseconds: f64,
    longest: Duration,
    waiting: TruthQueue<ColorFrameResult>,
    errors: RunningErrors,
    /// Error of dead reckoning from the same start, m, and number of frames that have one.
    dead_reckoning: (f64, usize),
    n_false_tracking: usize,
}

impl ColorTotals {
    /// Takes the newest frame, if it is new, and compares frames with the truth up to `now`.
    pub(super) fn take(&mut self, now: Stamp, system: &ColorSystem, truth: &ReferencePath) {
        let n_frames = system.sample().n_seen();
        if let Some(frame) = system.latest().filter(|_| self.n_frames < n_frames) {
            self.n_frames = n_frames;
            self.effective_particles += frame.effective_particles;
            self.n_particles += frame.n_particles as f64;
            self.milliseconds += 1e3 * frame.step.as_secs_f64();
            self.longest = self.longest.max(frame.step);
            self.waiting.push(frame.stamp, frame.clone());
        }
        self.compare(Some(now), truth);
    }

    /// Compares frames with the truth; without `now` all that are left.
    pub(super) fn compare(&mut self, now: Option<Stamp>, truth: &ReferencePath) {
        while let Some((frame, truth)) = self.waiting.pop(now, truth) {
            truth.into_iter().for_each(|truth| self.add(&frame, truth));
        }
    }

    fn add(&mut self, frame: &ColorFrameResult, truth: Pose2<f64>) {
        let pose = frame.beside(truth);
        self.errors.add(&pose);
        if let Some(odometry) = frame.odometry {
            self.dead_reckoning.0 += (odometry.translation - truth.translation).norm();
            self.dead_reckoning.1 += 1;
        }
        let is_far = pose.position_error() > 0.25 || pose.heading_error().to_degrees() > 6.0; // docs/color.md
        self.n_false_tracking += usize::from(is_far && frame.status == LocalizationStatus::Tracking);
    }

    /// Errors of the estimates, where there is truth.
    pub(super) fn errors(&self) -> Vec<Metric> {
        let mut metrics = self.errors.metrics();
        let (sum, n) = self.dead_reckoning;
        if n > 0 && n == self.errors.n() {
            metrics.push(Metric::new("dead_reckoning_position_error_mean_m", sum / n as f64, "m"));
        }
        if !metrics.is_empty() {
            metrics.push(Metric::new("n_false_tracking_frames", self.n_false_tracking as f64, ""));
        }
        metrics
    }

    /// Numbers of particles and of frames.
    pub(super) fn particles(&self) -> [Metric; 3] {
        let mean = |sum: f64| sum / self.n_frames.max(1) as f64;
        [
            Metric::new("ess_mean", mean(self.effective_particles), ""),
            Metric::new("n_particles_mean", mean(self.n_particles), ""),
            Metric::new("n_frames", self.n_frames as f64, ""),
        ]
    }

    /// Computing time of a frame.
    pub(super) fn timings(&self) -> Vec<Metric> {
        let mean = self.milliseconds / self.n_frames.max(1) as f64;
        let longest = 1e3 * self.longest.as_secs_f64();
        vec![Metric::new("frame_mean_ms", mean, "ms"), Metric::new("frame_max_ms", longest, "ms")]
    }
}
