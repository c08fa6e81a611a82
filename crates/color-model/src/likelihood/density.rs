use nalgebra::{Matrix3, Vector3};

use crate::{ColorDensity, ColorModelError, PixelSums};

/// A colour's density, factored once, for single pixels and for sums of many.
///
/// $`\sum_c \ln N(c; μ, S) = n \ln N(μ; μ, S) - \tfrac{1}{2} \operatorname{tr} S^{-1} \sum_c (c - μ)(c - μ)^T`$, so a region's
/// log-likelihood needs only the [`PixelSums`] of its pixels.
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use wayfix_color_model::{ColorDensity, PixelSums, PixelSumDensity};
/// let green = ColorDensity { mean: Vector3::new(90.0, 110.0, 100.0), covariance: Matrix3::identity() * 25.0 };
/// let density = PixelSumDensity::new(&green)?;
/// let mut sums = PixelSums::default();
/// sums.add_pixel([91, 112, 99]);
/// assert!((density.sum_log(&sums) - density.log([91, 112, 99])).abs() < 1e-9);
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSumDensity {
    mean: Vector3<f64>,
    information: Matrix3<f64>,
    log_peak: f64,
}

impl PixelSumDensity {
    /// Factors the covariance.
    ///
    /// # Errors
    /// Returns an error if the mean is not finite or the covariance not positive definite.
    pub fn new(density: &ColorDensity) -> Result<Self, ColorModelError> {
        let refused = ColorModelError::DensityNotPositive;
        let information = density.covariance.cholesky().ok_or(refused)?;
        let log_sqrt_determinant: f64 = information.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        let log_peak = -1.5 * std::f64::consts::TAU.ln() - log_sqrt_determinant;
        if !log_peak.is_finite() || !density.mean.iter().all(|v| v.is_finite()) {
            return Err(ColorModelError::DensityNotPositive);
        }
        Ok(Self { mean: density.mean, information: information.inverse(), log_peak })
    }

    /// $`\ln N(c; μ, S)`$ of one pixel.
    pub fn log(&self, pixel: [u8; 3]) -> f64 {
        self.log_at(&Vector3::from(pixel.map(f64::from)))
    }

    /// $`\ln N(c; μ, S)`$ of any point of the colour space.
    pub fn log_at(&self, color: &Vector3<f64>) -> f64 {
        let from_mean = color - self.mean;
        self.log_peak - 0.5 * from_mean.dot(&(self.information * from_mean))
    }

    /// $`\sum_c \ln N(c; μ, S)`$ over all pixels of a sum.
    pub fn sum_log(&self, sums: &PixelSums) -> f64 {
        let scatter = sums.scatter_about(&self.mean);
        sums.count() as f64 * self.log_peak - 0.5 * self.information.dot(&scatter)
    }
}
