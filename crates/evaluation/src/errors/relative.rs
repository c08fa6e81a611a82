use wayfix_estimation_traits::{LieGroup, Pose2, wrap_angle};

use super::PoseWithTruth;
use crate::report::Metric;

/// Errors of the motion between poses, which no alignment of the whole path changes. [Sturm et al. 2012, relative pose error]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeErrors {
    /// Mean distance between estimated and true motion, per m of the true path, m/m; `None` if the path is shorter than 1 m.
    pub per_meter: Option<f64>,
    /// Mean heading error of the motion, per radian that the true heading turned, rad/rad; `None` if it turned less than a radian.
    pub per_radian: Option<f64>,
}

impl RelativeErrors {
    /// The figures `rpe_m_per_m` and `rpe_rad_per_rad`, as far as the path has them.
    pub fn metrics(&self) -> impl Iterator<Item = Metric> {
        let per_meter = self.per_meter.map(|error| Metric::new("rpe_m_per_m", error, "m/m"));
        let per_radian = self.per_radian.map(|error| Metric::new("rpe_rad_per_rad", error, "rad/rad"));
        per_meter.into_iter().chain(per_radian)
    }
}

/// Relative errors over pieces of one metre and of one radian, from every sample on.
///
/// ```
/// use nalgebra::Matrix3;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_evaluation::errors::{PoseWithTruth, relative_errors};
/// let sample = |k: u32| PoseWithTruth {
///     estimate: Pose2::new(5.0 + 1.1 * f64::from(k), 7.0, 0.0), // ten percent too long, from another start
///     covariance: Matrix3::identity(),
///     truth: Pose2::new(f64::from(k), 0.0, 0.0),
/// };
/// let errors = relative_errors(&[sample(0), sample(1), sample(2), sample(3)]);
/// assert!((errors.per_meter.unwrap() - 0.1).abs() < 1e-12 && errors.per_radian.is_none());
/// assert!(errors.metrics().all(|metric| metric.name == "rpe_m_per_m"));
/// ```
pub fn relative_errors(samples: &[PoseWithTruth]) -> RelativeErrors {
    let step = |pair: &[PoseWithTruth]| {
        let moved = (pair[1].truth.translation - pair[0].truth.translation).norm();
        (moved, wrap_angle(pair[1].truth.heading() - pair[0].truth.heading()).abs())
    };
    let (mut meters, mut radians) = (vec![0.0], vec![0.0]);
    for (moved, turned) in samples.windows(2).map(step) {
        meters.push(meters[meters.len() - 1] + moved);
        radians.push(radians[radians.len() - 1] + turned);
    }
    let error = |from: usize, to: usize| {
        let motion =
            |of: fn(&PoseWithTruth) -> Pose2<f64>| of(&samples[from]).inverse().compose(&of(&samples[to]));
        let (estimate, truth) = (motion(|sample| sample.estimate), motion(|sample| sample.truth));
        let off = truth.inverse().compose(&estimate);
        (off.translation.norm(), off.heading().abs())
    };
    RelativeErrors {
        per_meter: mean_over_pieces(&meters, |from, to| error(from, to).0),
        per_radian: mean_over_pieces(&radians, |from, to| error(from, to).1),
    }
}

/// The mean error per unit over all shortest pieces of at least one unit; `along` never falls.
fn mean_over_pieces(along: &[f64], error: impl Fn(usize, usize) -> f64) -> Option<f64> {
    let (mut sum, mut n_pieces, mut to) = (0.0, 0.0, 0);
    for (from, start) in along.iter().enumerate() {
        while along.get(to).is_some_and(|end| end - start < 1.0) {
            to += 1;
        }
        let Some(end) = along.get(to) else { break };
        sum += error(from, to) / (end - start);
        n_pieces += 1.0;
    }
    (n_pieces > 0.0).then(|| sum / n_pieces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use nalgebra::Matrix3;

    fn turning(scale: f64, n: u32) -> Vec<PoseWithTruth> {
        let sample = |k: u32| PoseWithTruth {
            estimate: Pose2::new(0.0, 0.0, scale * 0.5 * f64::from(k)),
            covariance: Matrix3::identity(),
            truth: Pose2::new(0.0, 0.0, 0.5 * f64::from(k)),
        };
        (0..n).map(sample).collect()
    }

    #[test]
    fn a_turn_that_is_too_short_errs_per_radian() {
        let errors = relative_errors(&turning(0.9, 20)); // beyond ±π
        assert_abs_diff_eq!(errors.per_radian.unwrap(), 0.1, epsilon = 1e-12);
        assert_eq!(errors.per_meter, None);
    }

    #[test]
    fn a_short_path_has_no_relative_errors() {
        assert_eq!(relative_errors(&turning(1.0, 2)), relative_errors(&[]));
        assert_eq!(relative_errors(&[]), RelativeErrors { per_meter: None, per_radian: None });
    }
}
