use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::{Gaussian, check_covariance, cholesky, symmetrize};

use super::GaussianFusionRule;
use super::split::{Split, intersect};
use crate::{AppearanceMapError, PoseHypothesis};

/// Combines two Gaussians of the same place.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{GaussianFusionRule, PoseHypothesis, combine};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let belief = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.2, 0.2, 0.1))?;
/// let a = PoseHypothesis::new(0.5, belief.clone());
/// // The same estimate twice carries no new information ...
/// let twice = combine(&a, &a, GaussianFusionRule::WeightedIntersection)?;
/// assert!((twice.covariance() - belief.covariance()).norm() < 1e-12);
/// // ... unless both are independent.
/// let fresh = PoseHypothesis { independent: 1.0, ..a.clone() };
/// let fused = combine(&fresh, &fresh, GaussianFusionRule::SplitIntersection)?;
/// assert!((fused.covariance() * 2.0 - belief.covariance()).norm() < 1e-12);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// Returns an error if a covariance is singular or a number is not finite.
pub fn combine(
    a: &PoseHypothesis,
    b: &PoseHypothesis,
    combination: GaussianFusionRule,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let at = a.gaussian.mean();
    let seen = b.gaussian.in_chart_at(at)?;
    check_covariance("first", a.gaussian.covariance())?;
    check_covariance("second", seen.covariance())?;
    let (step, covariance) = match combination {
        GaussianFusionRule::WeightedIntersection => {
            let share = share(a, b);
            weighted_intersection(a.gaussian.covariance(), (seen.mean(), seen.covariance()), share)?
        }
        GaussianFusionRule::SplitIntersection => intersect(
            &Split::new(Vector3::zeros(), a.gaussian.covariance(), a.independent),
            &Split::new(*seen.mean(), seen.covariance(), b.independent),
        )?,
    };
    carried(at, &step, &covariance)
}

/// $`α = w_b \det C_a / (w_b \det C_a + w_a \det C_b)`$. [Gross et al. 2005, Eq. 5]
fn share(a: &PoseHypothesis, b: &PoseHypothesis) -> f64 {
    let for_a = a.weight * b.gaussian.covariance().determinant();
    let for_b = b.weight * a.gaussian.covariance().determinant();
    let sum = for_a + for_b;
    // Without weights, or beyond the range of numbers, both count the same.
    if sum > 0.0 && sum.is_finite() { for_b / sum } else { 1.0 / 2.0 }
}

/// $`C^{-1} = (1-α) C_a^{-1} + α C_b^{-1}`$, $`μ = C ((1-α) C_a^{-1} μ_a + α C_b^{-1} μ_b)`$ in the chart at $`μ_a`$.
/// [Gross et al. 2005, Eqs. 3–4, the inverses put in]
fn weighted_intersection(
    a: &Matrix3<f64>,
    (mean_b, b): (&Vector3<f64>, &Matrix3<f64>),
    share: f64,
) -> Result<(Vector3<f64>, Matrix3<f64>), AppearanceMapError> {
    let information = |covariance| cholesky("intersected", covariance).map(|factor| factor.inverse());
    let (from_a, from_b) = (information(a)? * (1.0 - share), information(b)? * share);
    let factor = cholesky("combined information", &(from_a + from_b))?;
    Ok((factor.solve(&(from_b * mean_b)), factor.inverse()))
}

/// The Gaussian at `step` from `at`, its covariance turned from the one body frame to the other.
pub(crate) fn carried(
    at: &Pose2<f64>,
    step: &Vector3<f64>,
    covariance: &Matrix3<f64>,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let mean = at.retract(step);
    let turn = at.chart_jacobian(&mean);
    let mut covariance = turn * covariance * turn.transpose();
    symmetrize(&mut covariance);
    Ok(Gaussian::new(mean, covariance)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    fn hypothesis(weight: f64, pose: [f64; 3], sigmas: [f64; 3]) -> PoseHypothesis {
        let [x, y, heading] = pose;
        let gaussian = Gaussian::from_sigmas(Pose2::new(x, y, heading), &Vector3::from(sigmas));
        PoseHypothesis::new(weight, gaussian.expect("sigmas are positive"))
    }

    #[test]
    fn the_heavier_and_the_narrower_draw_the_result() {
        let near = |a: &PoseHypothesis, b: &PoseHypothesis| {
            combine(a, b, GaussianFusionRule::WeightedIntersection).unwrap().mean().x()
        };
        let (left, right) = (hypothesis(1.0, [0.0; 3], [0.2; 3]), hypothesis(1.0, [0.1, 0.0, 0.0], [0.2; 3]));
        assert!(abs_diff_eq!(near(&left, &right), 0.05, epsilon = 1e-12), "equals meet half way");
        let heavy = PoseHypothesis { weight: 3.0, ..right.clone() };
        // α = 3/4 with equal covariances puts the mean at three quarters of the way.
        assert_abs_diff_eq!(near(&left, &heavy), 0.075, epsilon = 1e-12);
        assert!(near(&left, &hypothesis(1.0, [0.1, 0.0, 0.0], [0.1; 3])) > 0.09);
    }

    #[test]
    fn covariances_turn_with_the_mean() {
        // A belief narrow ahead that faces left is narrow across the way of one that faces ahead.
        let ahead = hypothesis(1.0, [0.0, 0.0, 0.0], [1.0, 1.0, 0.5]);
        let left = hypothesis(1.0, [0.0, 0.0, std::f64::consts::FRAC_PI_2], [0.1, 1.0, 2.0]);
        for combination in [GaussianFusionRule::WeightedIntersection, GaussianFusionRule::SplitIntersection] {
            let fused = combine(&ahead, &left, combination).unwrap();
            let world = fused.mean().rotation_matrix()
                * fused.covariance().fixed_view::<2, 2>(0, 0)
                * fused.mean().rotation_matrix().transpose();
            assert!(world[(1, 1)] < 0.2 * world[(0, 0)], "{combination:?}: {world}");
        }
    }

    #[test]
    fn the_order_of_two_does_not_matter() {
        let (a, b) = (
            hypothesis(0.3, [1.0, 2.0, 3.0], [0.2, 0.1, 0.1]),
            hypothesis(0.6, [1.1, 2.1, -3.1], [0.1, 0.3, 0.2]),
        );
        for combination in [GaussianFusionRule::WeightedIntersection, GaussianFusionRule::SplitIntersection] {
            let (one, other) = (combine(&a, &b, combination).unwrap(), combine(&b, &a, combination).unwrap());
            // The charts differ by a turn of 0.18 rad, which the retraction bends to second order.
            assert!(one.mean().local(other.mean()).norm() < 0.02, "{combination:?}");
        }
    }

    #[test]
    fn singular_covariances_are_refused() {
        let good = hypothesis(1.0, [0.0; 3], [0.2; 3]);
        for bad in [Matrix3::zeros(), Matrix3::from_element(f64::NAN), -Matrix3::identity()] {
            let flat =
                PoseHypothesis::new(1.0, Gaussian::from_parts_unchecked(Pose2::new(0.0, 0.0, 0.0), bad));
            for combination in
                [GaussianFusionRule::WeightedIntersection, GaussianFusionRule::SplitIntersection]
            {
                assert!(combine(&good, &flat, combination).is_err());
                assert!(combine(&flat, &good, combination).is_err());
            }
        }
    }
}
