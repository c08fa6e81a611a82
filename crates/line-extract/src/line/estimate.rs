use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix2, Vector2};

use super::hessian::{HessianLine, wrap};
use crate::LineExtractionError;

/// A line and the covariance of its $`(ρ, α)`$, in m², m rad and rad².
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineEstimate {
    /// The line.
    pub line: HessianLine,
    /// Covariance of $`(ρ, α)`$.
    pub covariance: Matrix2<f64>,
}

impl LineEstimate {
    /// The squared Mahalanobis distance $`Δ^T (P_1 + P_2)^{-1} Δ`$ of two independent estimates; chi-squared with two degrees of freedom if both are
    /// of one line.
    ///
    /// $`Δ`$ is the smaller of two differences: $`(ρ, α)`$ and $`(-ρ, α + π)`$ are one line, and close to the origin noise decides which is
    /// estimated.
    /// ```
    /// use nalgebra::Matrix2;
    /// use wayfix_line_extract::{HessianLine, LineEstimate};
    ///
    /// let estimate = |rho, alpha| LineEstimate {
    ///     line: HessianLine::new(rho, alpha),
    ///     covariance: Matrix2::from_diagonal_element(1e-4),
    /// };
    /// // 2 cm apart with a deviation of 1 cm each; the second time on both sides of the origin.
    /// assert!((estimate(1.0, 0.3).mahalanobis_squared(&estimate(1.02, 0.3))? - 2.0).abs() < 1e-9);
    /// assert!((estimate(0.01, 0.3).mahalanobis_squared(&estimate(-0.01, 0.3))? - 2.0).abs() < 1e-9);
    /// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`LineExtractionError::NotPositiveDefinite`] if the sum of the covariances is not.
    pub fn mahalanobis_squared(&self, other: &Self) -> Result<f64, LineExtractionError> {
        let turned = wrap(other.line.alpha() - self.line.alpha());
        // The other form has the other sign of ρ, and so of the covariance between ρ and α.
        let (rho, turned, sign) = if turned.abs() > FRAC_PI_2 {
            (-other.line.rho(), wrap(turned + PI), -1.0)
        } else {
            (other.line.rho(), turned, 1.0)
        };
        let delta = Vector2::new(rho - self.line.rho(), turned);
        let (p, q) = (&self.covariance, &other.covariance);
        let (a, b, d) = (p[(0, 0)] + q[(0, 0)], p[(0, 1)] + sign * q[(0, 1)], p[(1, 1)] + q[(1, 1)]);
        let determinant = a * d - b * b;
        if !(determinant > 0.0 && a > 0.0) {
            return Err(LineExtractionError::NotPositiveDefinite { determinant });
        }
        Ok((d * delta.x * delta.x - 2.0 * b * delta.x * delta.y + a * delta.y * delta.y) / determinant)
    }

    /// The variance of the line's place, perpendicular to it, `along` metres from the foot of the origin's perpendicular.
    ///
    /// $`σ_ρ^2 - 2 s σ_{ρα} + s^2 σ_α^2`$, from $`e = p \cdot n(α) - ρ`$ at a point with $`s = p \cdot n'(α)`$. Square metres.
    pub fn variance_at(&self, along: f64) -> f64 {
        let p = &self.covariance;
        p[(0, 0)] - 2.0 * along * p[(0, 1)] + along * along * p[(1, 1)]
    }
}
