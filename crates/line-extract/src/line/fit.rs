use nalgebra::{Matrix2, Vector2};

use super::{LineEstimate, Moments};
use crate::{LineExtractionError, check};

/// A fitted line with its goodness of fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineFit {
    /// The line and its covariance.
    pub estimate: LineEstimate,
    /// Weighted root mean square distance of the points, metres.
    pub rms_m: f64,
    /// Sum of squared distances over their variances; chi-squared with two degrees of freedom fewer than points.
    pub chi_squared: f64,
}

/// The total least squares line through points with covariances (m²), which minimizes $`\sum_i e_i^2 / σ_i^2`$ with
/// $`e_i = n \cdot p_i - ρ`$ and $`σ_i^2 = n^T C_i n`$ [Pfister, Roumeliotis & Burdick 2003].
///
/// The variances depend on the normal $`n`$, so the fit is iterated with those of the last line; it starts from equal ones.
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use wayfix_line_extract::fit_line;
///
/// let points: Vec<_> = (-5..=5).map(|k| Vector2::new(3.0, f64::from(k))).collect();
/// let fit = fit_line(&points, &[Matrix2::from_diagonal_element(1e-4); 11])?;
/// assert!((fit.estimate.line.rho() - 3.0).abs() < 1e-12 && fit.estimate.line.alpha().abs() < 1e-12);
/// // σ²/n and σ²/Σs²
/// assert!((fit.estimate.covariance[(0, 0)] - 1e-4 / 11.0).abs() < 1e-12);
/// assert!((fit.estimate.covariance[(1, 1)] - 1e-4 / 110.0).abs() < 1e-12);
/// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
/// ```
///
/// # Errors
/// Returns [`LineExtractionError::Sizes`] unless there is a covariance for each point, [`LineExtractionError::TooFewPoints`] for fewer than two, [`LineExtractionError::Point`] and
/// [`LineExtractionError::Param`] for points or variances that are not finite (variances: positive), [`LineExtractionError::NoDirection`] if all points are in one place.
pub fn fit_line(
    points: &[Vector2<f64>],
    covariances: &[Matrix2<f64>],
) -> Result<LineFit, LineExtractionError> {
    let got = points.len();
    if covariances.len() != got {
        return Err(LineExtractionError::Sizes { points: got, covariances: covariances.len() });
    }
    if got < 2 {
        return Err(LineExtractionError::TooFewPoints { got, needed: 2 });
    }
    check::points(points, LARGEST)?;
    let mut moments = Moments::new(points, |_| 1.0);
    for _ in 0..ROUNDS {
        let normal = moments.line()?.line.normal();
        let variance = |k: usize| normal.dot(&(covariances[k] * normal));
        if let Some(k) = (0..got).find(|k| !(variance(*k) > 0.0 && variance(*k).is_finite())) {
            return Err(LineExtractionError::Param {
                what: "variance of a point (m²)",
                value: variance(k),
                must: "positive",
            });
        }
        moments = Moments::new(points, |k| 1.0 / variance(k));
    }
    let estimate = moments.line()?;
    let line = &estimate.line;
    Ok(LineFit { estimate, rms_m: moments.rms(line), chi_squared: moments.chi_squared(line) })
}

/// The normal turns by the noise over the length at most, and the variances by less: two rounds settle it.
const ROUNDS: usize = 2;
/// So that fourth powers do not overflow.
const LARGEST: f64 = 1e70;
