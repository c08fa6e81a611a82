use nalgebra::{Matrix3, Matrix4, Vector3};
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::{LieGroup, Manifold, MotionModel, Pose2};
use wayfix_scan_match::ScanAlignment;
use wayfix_slam_ekf::{OdometryMotion, PoseWithHeadingDrift};

use super::OdometryNoisePerScan;

/// The motion since the last keyframe by odometry, corrected by the matches since, with its covariance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelativeMotion {
    /// The motion, in the frame of the robot at the keyframe, with the drift that is estimated taken out.
    pub motion: Pose2<f64>,
    /// Covariance in the frame at its end, but for the drift.
    pub covariance: Matrix3<f64>,
    /// Derivative by the drift.
    pub drift_jacobian: Vector3<f64>,
    /// Where the robot was at the last scan.
    pub pose_at_last_scan: Pose2<f64>,
    /// How it had moved from the scan before that.
    pub last_step: Pose2<f64>,
}

impl Default for RelativeMotion {
    /// No motion.
    fn default() -> Self {
        Self {
            motion: Pose2::identity(),
            covariance: Matrix3::zeros(),
            drift_jacobian: Vector3::zeros(),
            pose_at_last_scan: Pose2::identity(),
            last_step: Pose2::identity(),
        }
    }
}

/// A motion of zero is known this well at least, m and rad: scans may contradict odometry that stands.
const SMALLEST_SIGMA: f64 = 1e-3;

impl RelativeMotion {
    /// One increment more, of odometry that turns by `drift` rad/m without turning.
    pub(super) fn then(&self, noise: &OdometryMotion, drift: f64, increment: &Pose2<f64>) -> Self {
        let distance = increment.translation.norm();
        let moved = Pose2::new(increment.x(), increment.y(), increment.heading() + drift * distance);
        let carry = noise.jacobian(&self.motion, &moved);
        Self {
            motion: noise.propagate(&self.motion, &moved),
            covariance: carry * self.covariance * carry.transpose() + noise.noise(&self.motion, &moved),
            drift_jacobian: carry * self.drift_jacobian + Vector3::z() * distance,
            ..*self
        }
    }

    /// Where the robot could be if its wheels are wrong: where it was at the last scan, or gone on as before.
    pub(super) fn guesses_without_odometry(&self) -> [Pose2<f64>; 2] {
        [self.pose_at_last_scan, self.pose_at_last_scan.compose(&self.last_step)]
    }

    /// The same once a scan has said where it ends.
    pub(super) fn after_scan(self) -> Self {
        let last_step = self.pose_at_last_scan.inverse().compose(&self.motion);
        Self { pose_at_last_scan: self.motion, last_step, ..self }
    }

    /// A new motion, from where this one ends.
    pub(super) fn reset_at_keyframe(&self) -> Self {
        Self { last_step: self.last_step, ..Self::default() }
    }

    /// The same at the time of a scan, with what odometry and scan disagree by. Odometry that stands still may disagree as well: wheels
    /// slip, and records are lost.
    pub(super) fn with_odometry_noise_per_scan(self, odometry_noise_per_scan: &OdometryNoisePerScan) -> Self {
        let OdometryNoisePerScan { translation_sigma, heading_sigma } = *odometry_noise_per_scan;
        let sigmas = Vector3::new(translation_sigma, translation_sigma, heading_sigma);
        self.with_added_covariance(&Matrix3::from_diagonal(&sigmas.map(|sigma| sigma * sigma)))
    }

    /// The same with an error more.
    pub(super) fn with_added_covariance(self, covariance: &Matrix3<f64>) -> Self {
        Self { covariance: self.covariance + covariance, ..self }
    }

    /// Whether the robot is still about where it was.
    pub(super) fn is_within(&self, distance: f64, turn: f64) -> bool {
        self.motion.translation.norm() < distance && self.motion.heading().abs() < turn
    }

    /// Whether every number is one.
    pub(super) fn is_finite(&self) -> bool {
        let poses = [self.motion, self.pose_at_last_scan, self.last_step];
        let numbers = self.covariance.iter().chain(&self.drift_jacobian);
        poses.iter().all(Pose2::is_finite) && numbers.into_iter().all(|number| number.is_finite())
    }

    /// Covariance of the motion, with that of the drift.
    pub(super) fn total_covariance(&self, drift_variance: f64) -> Matrix3<f64> {
        self.covariance
            + self.drift_jacobian * drift_variance * self.drift_jacobian.transpose()
            + Matrix3::identity() * SMALLEST_SIGMA.powi(2)
    }

    /// The same when its covariance proved too small by this factor.
    pub(super) fn with_scaled_covariance(self, scale: f64) -> Self {
        Self { covariance: self.covariance * scale.max(1.0), ..self }
    }

    /// The same once another sensor has changed the drift.
    pub(super) fn with_drift_changed_by(self, drift_change: f64) -> Self {
        Self { motion: self.motion.retract(&(self.drift_jacobian * drift_change)), ..self }
    }

    /// The correction of the drift by a match of two scans, and its variance; `None` if the match gives no information.
    ///
    /// The match measures $`δ = b\, κ + w`$ with information $`Λ`$, where $`w`$ is the error of odometry without the drift, with covariance $`Q`$.
    pub(super) fn drift_from_match(&self, found: &ScanAlignment) -> Option<(f64, f64)> {
        let gain = (Matrix3::identity() + found.information * self.covariance).try_inverse()?;
        let information = self.drift_jacobian.dot(&(gain * found.information * self.drift_jacobian));
        let change = self.drift_jacobian.dot(&(gain * found.information_vector)) / information;
        (information > NOTHING && change.is_finite()).then(|| (change, 1.0 / information))
    }

    /// The motion that odometry and a match make together, once the drift has changed by `drift_change`.
    pub(super) fn corrected_by(&self, found: &ScanAlignment, drift_change: f64) -> Option<Self> {
        let Self { motion, covariance, drift_jacobian, .. } = *self;
        // Q (1 + Λ Q)⁻¹ is (Q⁻¹ + Λ)⁻¹, also where odometry is certain.
        let posterior = covariance * (Matrix3::identity() + found.information * covariance).try_inverse()?;
        let posterior = posterior.symmetric_part();
        let by_drift_left = drift_jacobian - posterior * found.information * drift_jacobian;
        let correction = posterior * found.information_vector + by_drift_left * drift_change;
        let motion = motion.retract(&correction);
        Some(Self { motion, covariance: posterior, drift_jacobian: by_drift_left, ..*self })
    }
}

/// Information below this, m²/rad², cannot change a drift that is known to a thousandth of a radian on a metre.
const NOTHING: f64 = 1.0;

/// The motion model of a [`RelativeMotion`]: noise and derivative come with the motion.
impl MotionModel for RelativeMotion {
    type State = PoseWithHeadingDrift;
    type Control = Pose2<f64>;

    fn propagate(&self, state: &PoseWithHeadingDrift, motion: &Pose2<f64>) -> PoseWithHeadingDrift {
        PoseWithHeadingDrift { pose: state.pose.compose(motion), ..*state }
    }
    fn jacobian(&self, _: &PoseWithHeadingDrift, motion: &Pose2<f64>) -> Matrix4<f64> {
        let mut jacobian = motion.inverse().adjoint().to_homogeneous();
        jacobian.fixed_view_mut::<3, 1>(0, 3).copy_from(&self.drift_jacobian);
        jacobian
    }
    fn noise(&self, _: &PoseWithHeadingDrift, _: &Pose2<f64>) -> Matrix4<f64> {
        let mut noise = self.covariance.to_homogeneous();
        noise.m44 = 0.0;
        noise
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::{Matrix4, linalg::Cholesky};

    use super::*;

    /// Drift and motion, corrected one after the other as the system does, are what conditioning their joint Gaussian at once gives.
    #[test]
    fn a_match_corrects_drift_and_way_as_one_gaussian() {
        let noise = OdometryMotion { heading_variance_per_meter: 0.01, ..OdometryMotion::default() };
        let increments = [(0.3, 0.1), (0.4, -0.3), (0.2, 0.5)].map(|(x, turn)| Pose2::new(x, 0.02, turn));
        let relative_motion = increments.iter().fold(RelativeMotion::default(), |relative_motion, step| {
            relative_motion.then(&noise, 0.02, step)
        });
        let (drift_variance, asked) = (0.05_f64.powi(2), Vector3::new(0.03, -0.02, 0.06));
        let information = Matrix3::new(900.0, 100.0, 50.0, 100.0, 400.0, 20.0, 50.0, 20.0, 2500.0);

        // (κ, δ) with δ = b κ + w, and a measurement of δ.
        let mut joint = Matrix4::zeros();
        joint.fixed_view_mut::<3, 3>(1, 1).copy_from(
            &(relative_motion.covariance
                + relative_motion.drift_jacobian
                    * drift_variance
                    * relative_motion.drift_jacobian.transpose()),
        );
        joint[(0, 0)] = drift_variance;
        for row in 0..3 {
            joint[(0, row + 1)] = relative_motion.drift_jacobian[row] * drift_variance;
            joint[(row + 1, 0)] = joint[(0, row + 1)];
        }
        let looked_at = joint.fixed_view::<3, 3>(1, 1) + information.try_inverse().unwrap();
        let gain = joint.fixed_columns::<3>(1) * Cholesky::new(looked_at).unwrap().inverse();
        let mean = gain * asked;
        let posterior = joint - gain * joint.fixed_rows::<3>(1);

        let found = ScanAlignment {
            pose: relative_motion.motion,
            correction: Vector3::zeros(),
            information,
            information_vector: information * asked,
            guess_scale: 1.0,
            overlap: 1.0,
        };
        let (change, variance) = relative_motion.drift_from_match(&found).unwrap();
        let weight = drift_variance / (drift_variance + variance);
        let left = drift_variance * (1.0 - weight);
        let corrected = relative_motion.corrected_by(&found, weight * change).unwrap();
        assert_abs_diff_eq!(weight * change, mean[0], epsilon = 1e-9);
        assert_abs_diff_eq!(left, posterior[(0, 0)], epsilon = 1e-9);
        assert_abs_diff_eq!(
            relative_motion.motion.local(&corrected.motion),
            mean.fixed_rows::<3>(1).into_owned(),
            epsilon = 1e-9
        );
        let total =
            corrected.covariance + corrected.drift_jacobian * left * corrected.drift_jacobian.transpose();
        assert_abs_diff_eq!(total, posterior.fixed_view::<3, 3>(1, 1).into_owned(), epsilon = 1e-9);
    }

    /// To first order in the change: increments of half a metre, turned by 1e-3 rad/m.
    #[test]
    fn a_changed_drift_changes_the_motion_as_if_known_before() {
        let along = |drift: f64| {
            let increments = [(0.3, 0.1), (0.4, -0.3), (0.2, 0.5)].map(|(x, turn)| Pose2::new(x, 0.02, turn));
            increments.iter().fold(RelativeMotion::default(), |relative_motion, step| {
                relative_motion.then(&OdometryMotion::default(), drift, step)
            })
        };
        let changed = along(0.02).with_drift_changed_by(1e-3);
        assert_abs_diff_eq!(changed.motion.local(&along(0.021).motion), Vector3::zeros(), epsilon = 1e-6);
        assert!(along(0.02).motion.local(&changed.motion).norm() > 5e-4);
    }

    #[test]
    fn standstill_of_odometry_is_no_certain_standstill() {
        let still = RelativeMotion::default().then(&OdometryMotion::default(), 0.1, &Pose2::identity());
        let OdometryNoisePerScan { translation_sigma, heading_sigma } = OdometryNoisePerScan::default();
        let covariance = still.with_odometry_noise_per_scan(&OdometryNoisePerScan::default()).covariance;
        assert!(covariance.m11 >= translation_sigma.powi(2) && covariance.m33 >= heading_sigma.powi(2));
    }
}
