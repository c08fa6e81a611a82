use nalgebra::{DMatrix, Vector1};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_scan_match::{InitialGuess, ScanAlignment, ScanPointCloud};
use wayfix_slam_ekf::{EkfSlam, HeadingDriftSensor};

use super::front_end::{WallModel, WallSlamFrontEnd, Walls};

/// Scans that have less in common are not laid on one another, share of points.
const LEAST_OVERLAP: f64 = 0.15;

/// A match of a scan to that of the last keyframe.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyframeMatch {
    /// The motion since the keyframe, as it was known before the match.
    pub(super) guess: Pose2<f64>,
    pub(super) found: ScanAlignment,
}

impl WallSlamFrontEnd {
    /// Corrects the motion since the last keyframe, and the drift, by matching a scan to that of the keyframe. Returns the match.
    pub(super) fn match_to_keyframe(
        &mut self,
        cloud: &ScanPointCloud,
        estimator: &mut Walls,
    ) -> Option<KeyframeMatch> {
        let mut matched = None;
        self.relative_motion =
            self.relative_motion.with_odometry_noise_per_scan(&self.params.odometry_noise_per_scan);
        if let (Some(keyframe), Some(matcher)) = (&self.last_keyframe, self.matcher) {
            let drift_variance = estimator.filter.robot_covariance()[(3, 3)];
            let covariance = self.relative_motion.total_covariance(drift_variance);
            let others = self.relative_motion.guesses_without_odometry();
            let guess =
                InitialGuess { pose: self.relative_motion.motion, covariance, alternative_poses: &others };
            let found = matcher.align(&keyframe.cloud, cloud, &guess);
            if let Some(found) = found.ok().filter(|found| found.overlap >= LEAST_OVERLAP) {
                estimator.events.count("keyframe_matched");
                matched = Some(KeyframeMatch { guess: self.relative_motion.motion, found });
                let relative_motion = self.relative_motion.with_scaled_covariance(found.guess_scale);
                let drift_change = relative_motion
                    .drift_from_match(&found)
                    .map_or(0.0, |seen| correct_drift(seen, estimator));
                self.relative_motion =
                    relative_motion.corrected_by(&found, drift_change).unwrap_or(relative_motion);
            } else {
                estimator.events.count("keyframe_match_failed");
            }
        }
        self.relative_motion = self.relative_motion.after_scan();
        matched
    }
}

impl KeyframeMatch {
    /// The heading by the points alone, without odometry; `None` if they do not constrain a direction.
    pub(super) fn heading(&self) -> Option<f64> {
        let correction = self.found.information.try_inverse()? * self.found.information_vector;
        let heading = self.guess.retract(&correction).heading();
        heading.is_finite().then_some(heading)
    }
}

/// Corrects the drift by a change and its variance. Returns the change that the filter made: none if it refuses the measurement.
fn correct_drift((change, variance): (f64, f64), estimator: &mut Walls) -> f64 {
    let variance_of = |filter: &EkfSlam<WallModel>| filter.robot_covariance().m44;
    let (before, variance_before) = (estimator.filter.robot().heading_drift, variance_of(&estimator.filter));
    let measured = Vector1::new(before + change);
    if let Ok(innovation) = estimator.filter.update_robot(&HeadingDriftSensor(variance), &measured) {
        let jacobian = DMatrix::from_row_slice(1, 4, &[0.0, 0.0, 0.0, 1.0]);
        let covariance = DMatrix::from_element(1, 1, innovation.covariance[(0, 0)]);
        estimator.record_robot(&jacobian, &covariance);
        if let Some(follower) = &mut estimator.follower {
            let information = variance_of(&estimator.filter).recip() - variance_before.recip();
            follower.heading_drift_measured(measured.x, information);
        }
    }
    estimator.filter.robot().heading_drift - before
}
