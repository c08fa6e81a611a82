use nalgebra::{Matrix3, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_gaussian_core::{Gaussian, symmetrize};

use super::OdometryNoise;
use crate::AppearanceMapError;

/// A belief after the robot has moved by `increment`, given in the body frame at its beginning. [Gross et al. 2005, Eq. 1]
///
/// $`x' = x ∘ u`$, $`C' = F C F^T + Q(u)`$.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{OdometryNoise, propagate};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let moved = propagate(&start, &Pose2::new(2.0, 0.0, 0.0), &OdometryNoise::default())?;
/// assert_eq!(moved.mean().x(), 2.0);
/// assert!(moved.sigmas().y > 0.2); // a heading off by 0.1 rad is 0.2 m off to the side two metres on
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// [`AppearanceMapError::NotFinite`] when the increment is not finite, or the way to its end overflows.
pub fn propagate(
    belief: &Gaussian<Pose2<f64>>,
    increment: &Pose2<f64>,
    noise: &OdometryNoise,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let mean = belief.mean().compose(increment);
    let transition = transition(increment);
    let mut covariance =
        transition * belief.covariance() * transition.transpose() + noise.covariance(increment);
    symmetrize(&mut covariance);
    if !(mean.is_finite() && covariance.iter().all(|entry| entry.is_finite())) {
        return Err(AppearanceMapError::NotFinite { what: "odometry increment" });
    }
    Ok(Gaussian::from_parts_unchecked(mean, covariance))
}

/// $`∂(x ∘ u)/∂x`$ between body frames: what is ahead before the turn is beside after it, and a wrong heading sweeps the way sideways.
pub(crate) fn transition(increment: &Pose2<f64>) -> Matrix3<f64> {
    let back = increment.rotation_matrix().transpose();
    let swept = back * Vector2::new(-increment.y(), increment.x());
    let mut matrix = back.to_homogeneous();
    matrix[(0, 2)] = swept.x;
    matrix[(1, 2)] = swept.y;
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use wayfix_estimation_traits::numerical_jacobian;

    #[test]
    fn the_transition_is_the_derivative_of_the_composition() {
        let increment = Pose2::new(0.7, -0.3, 0.9);
        let start = Pose2::new(4.0, 2.0, 3.0);
        let numerical = numerical_jacobian(|x: &Pose2<f64>| x.compose(&increment), &start);
        // Central differences of smooth functions keep about two thirds of the digits.
        assert!((transition(&increment) - numerical).norm() < 1e-8);
    }

    #[test]
    fn odometry_that_is_not_finite_is_refused() {
        let start = Gaussian::from_parts_unchecked(Pose2::new(0.0, 0.0, 0.0), Matrix3::identity());
        for bad in [
            Pose2::new(f64::NAN, 0.0, 0.0),
            Pose2::new(0.0, f64::INFINITY, 0.0),
            Pose2::new(0.0, 0.0, f64::NAN),
        ] {
            assert!(propagate(&start, &bad, &OdometryNoise::default()).is_err());
        }
    }
}
