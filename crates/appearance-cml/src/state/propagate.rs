use wayfix_estimation_traits::{MotionModel, Pose2};
use wayfix_gaussian_core::{Gaussian, symmetrize};

use crate::AppearanceMapError;

/// A belief after the robot has moved by `increment`, given in the body frame at its beginning. [Gross et al. 2005, Eq. 1]
///
/// $`x' = f(x, u)`$, $`C' = F C F^T + Q(x, u)`$.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{OdometryNoise, propagate};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let moved = propagate(&start, &Pose2::new(2.0, 0.0, 0.0), &OdometryNoise::default())?;
/// assert_eq!(moved.mean().x(), 2.0);
/// assert!(moved.sigmas().y > 0.2); // a heading error of 0.1 rad is a lateral error of 0.2 m after 2 m
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// Returns [`AppearanceMapError::NotFinite`] if the increment is not finite, or if the result overflows.
pub fn propagate<M: MotionModel<State = Pose2<f64>, Control = Pose2<f64>>>(
    belief: &Gaussian<Pose2<f64>>,
    increment: &Pose2<f64>,
    motion: &M,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let mean = motion.propagate(belief.mean(), increment);
    let jacobian = motion.jacobian(belief.mean(), increment);
    let mut covariance =
        jacobian * belief.covariance() * jacobian.transpose() + motion.noise(belief.mean(), increment);
    symmetrize(&mut covariance);
    if !(mean.is_finite() && covariance.iter().all(|entry| entry.is_finite())) {
        return Err(AppearanceMapError::NotFinite { what: "odometry increment" });
    }
    Ok(Gaussian::from_parts_unchecked(mean, covariance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OdometryNoise;
    use nalgebra::Matrix3;

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
