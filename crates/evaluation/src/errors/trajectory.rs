use nalgebra::{Matrix3, Vector3, linalg::Cholesky};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, wrap_angle};

use super::{align, rms_distance};

/// An estimated pose beside the true one.
#[derive(Clone, Copy, Debug)]
pub struct PoseWithTruth {
    /// The estimate.
    pub estimate: Pose2<f64>,
    /// Its covariance in the body frame, `(x, y, θ)`.
    pub covariance: Matrix3<f64>,
    /// The truth.
    pub truth: Pose2<f64>,
}

impl PoseWithTruth {
    /// The truth seen from the estimate, `(x, y, θ)` in the estimated body frame.
    pub fn error(&self) -> Vector3<f64> {
        self.estimate.local(&self.truth)
    }

    /// The same in exponential coordinates, $`\log(\hat x^{-1} x)`$.
    pub fn exponential_error(&self) -> Vector3<f64> {
        self.estimate.inverse().compose(&self.truth).log()
    }

    /// Distance between the positions, m.
    pub fn position_error(&self) -> f64 {
        (self.estimate.translation - self.truth.translation).norm()
    }

    /// Angle between the headings, rad, not negative.
    pub fn heading_error(&self) -> f64 {
        wrap_angle(self.estimate.heading() - self.truth.heading()).abs()
    }

    /// Normalized estimation error squared, $`e^T P^{-1} e`$ with $`e`$ the truth seen from the estimate; chi-squared with three degrees
    /// of freedom for a consistent filter. `None` while some direction is known exactly.
    pub fn nees(&self) -> Option<f64> {
        self.nees_of(&self.error())
    }

    /// The same of an error in other coordinates, in which the covariance is the filter's.
    pub fn nees_of(&self, error: &Vector3<f64>) -> Option<f64> {
        let nees = error.dot(&Cholesky::new(self.covariance)?.solve(error));
        nees.is_finite().then_some(nees)
    }
}

/// Errors of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryErrors {
    /// Root mean square position error with the start pose given and no alignment, m.
    pub ate_rmse: f64,
    /// The same after the best rigid alignment of the whole path, m.
    pub ate_aligned_rmse: f64,
    /// Root mean square heading error without alignment, rad.
    pub heading_rmse: f64,
    /// Mean NEES over the samples that have one.
    pub nees_mean: Option<f64>,
}

/// Errors over all samples; `None` without samples.
pub fn trajectory_errors(samples: &[PoseWithTruth]) -> Option<TrajectoryErrors> {
    let positions = samples.iter().map(|sample| (sample.estimate.translation, sample.truth.translation));
    let identity = Pose2::new(0.0, 0.0, 0.0);
    let squared_turns = samples.iter().map(|sample| sample.heading_error().powi(2));
    let nees: Vec<f64> = samples.iter().filter_map(PoseWithTruth::nees).collect();
    Some(TrajectoryErrors {
        ate_rmse: rms_distance(positions.clone(), &identity)?,
        ate_aligned_rmse: rms_distance(positions.clone(), &align(positions))?,
        heading_rmse: (squared_turns.sum::<f64>() / samples.len() as f64).sqrt(),
        nees_mean: (!nees.is_empty()).then(|| nees.iter().sum::<f64>() / nees.len() as f64),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn errors_of_a_path_that_is_shifted_and_turned_by_known_amounts() {
        let covariance = Matrix3::from_diagonal(&Vector3::new(0.04, 0.04, 0.01));
        let sample = |x: f64| PoseWithTruth {
            estimate: Pose2::new(x, 0.3, 3.1),
            covariance,
            truth: Pose2::new(x, 0.0, -3.1),
        };
        let errors = trajectory_errors(&[sample(0.0), sample(1.0), sample(2.0)]).unwrap();
        let turn = 2.0 * (std::f64::consts::PI - 3.1); // across ±π, not 6.2
        assert_abs_diff_eq!(errors.ate_rmse, 0.3, epsilon = 1e-12);
        assert!(errors.ate_aligned_rmse < 1e-12);
        assert_abs_diff_eq!(errors.heading_rmse, turn, epsilon = 1e-12);
        // (0.3 / 0.2)² from the position, in whatever direction of the body, since its covariance is round; the rest from the heading.
        let nees = 2.25 + (turn / 0.1).powi(2);
        assert_abs_diff_eq!(errors.nees_mean.unwrap(), nees, epsilon = 1e-9);
    }

    #[test]
    fn a_pose_known_exactly_has_no_nees_and_no_pose_no_errors() {
        let pose = Pose2::new(1.0, 2.0, 3.0);
        let sample = PoseWithTruth { estimate: pose, covariance: Matrix3::zeros(), truth: pose };
        assert_eq!(sample.nees(), None);
        assert_eq!(trajectory_errors(&[sample]).unwrap().nees_mean, None);
        assert_eq!(trajectory_errors(&[]), None);
    }
}
