use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::{Gaussian, cholesky};

use crate::AppearanceMapError;

/// The squared Mahalanobis distance of two beliefs, each with its own covariance.
///
/// $`(μ_a ⊟ μ_b)^T (C_a + C_b)^{-1} (μ_a ⊟ μ_b)`$ in the body frame of $`a`$, the heading wrapped. [Gross et al. 2005, Eqs. 2, 12, 15]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::separation_squared;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let at = |x: f64, heading: f64| Gaussian::from_sigmas(Pose2::new(x, 0.0, heading), &Vector3::new(0.3, 0.3, 0.1));
/// let across_the_wrap = separation_squared(&at(0.0, 3.1)?, &at(0.6, -3.1)?)?;
/// assert!(across_the_wrap < 2.5); // 0.36 / 0.18 and a turn of 0.08 rad, not of 6.2
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// When something is not finite or the sum of the covariances is singular.
pub fn separation_squared(
    a: &Gaussian<Pose2<f64>>,
    b: &Gaussian<Pose2<f64>>,
) -> Result<f64, AppearanceMapError> {
    let seen = b.in_chart_at(a.mean())?;
    let factor = cholesky("sum of the beliefs'", &(a.covariance() + seen.covariance()))?;
    let deviation = a.mean().local(b.mean());
    let squared = deviation.dot(&factor.solve(&deviation));
    if squared.is_finite() { Ok(squared) } else { Err(AppearanceMapError::NotFinite { what: "belief" }) }
}
