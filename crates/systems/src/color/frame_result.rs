use std::time::Duration;

use wayfix_color_model::LocalizationStatus;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::errors::PoseWithTruth;
use wayfix_gaussian_core::Gaussian;
use wayfix_sensor_log::Stamp;

use super::ClassificationCounts;

/// Result of one frame.
#[derive(Clone, Debug)]
pub struct ColorFrameResult {
    /// Capture time.
    pub stamp: Stamp,
    /// The pose estimate, with covariance in its body frame.
    pub pose: Gaussian<Pose2<f64>>,
    /// Quality of the estimate.
    pub status: LocalizationStatus,
    /// Dead-reckoned pose; `None` without a known start.
    pub odometry: Option<Pose2<f64>>,
    /// Effective number of particles.
    pub effective_particles: f64,
    /// Number of particles.
    pub n_particles: usize,
    /// Probability of each light of the bank.
    pub light_probabilities: Vec<f64>,
    /// Classification counts, if the log has true labels.
    pub labelled: Option<ClassificationCounts>,
    /// Computing time after decoding; with a second camera, that of its images since the last frame too.
    pub step: Duration,
}

impl ColorFrameResult {
    /// The estimate beside the truth at its stamp.
    pub(super) fn beside(&self, truth: Pose2<f64>) -> PoseWithTruth {
        PoseWithTruth { estimate: *self.pose.mean(), covariance: *self.pose.covariance(), truth }
    }
}
