use nalgebra::RealField;
use wayfix_estimation_traits::{Angle, to_f64};

use crate::GaussianError;

/// Statistics of weighted directions, from their mean vector. [Mardia & Jupp 2000, Sec. 2.2-2.3]
///
/// ```
/// use wayfix_estimation_traits::Angle;
/// use wayfix_gaussian_core::CircularMoments;
/// let degrees = |d: f64| Angle::new(d.to_radians());
/// let moments = CircularMoments::from_weighted(&[degrees(350.0), degrees(10.0)], &[1.0, 1.0])?;
/// assert!(moments.mean_direction().is_some_and(|mean| mean.radians().abs() < 1e-15)); // not 180
/// assert!((moments.resultant_length() - 10.0_f64.to_radians().cos()).abs() < 1e-15);
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircularMoments {
    cos: f64,
    sin: f64,
}

impl CircularMoments {
    /// Of weighted directions; weights need not be normalized.
    ///
    /// # Errors
    /// Returns an error if lists are empty or uneven, an angle is not finite, a weight is negative or not finite, or all are zero.
    pub fn from_weighted<T: RealField + Copy>(
        angles: &[Angle<T>],
        weights: &[f64],
    ) -> Result<Self, GaussianError> {
        let count = angles.len();
        crate::gaussian::check_dimension("weights", count, weights.len())?;
        if count == 0 {
            return Err(GaussianError::Empty { what: "angles" });
        }
        let (mut cos, mut sin, mut sum) = (0.0, 0.0, 0.0);
        for (index, (angle, &weight)) in angles.iter().zip(weights).enumerate() {
            if !(weight >= 0.0 && weight.is_finite()) {
                return Err(GaussianError::Weight { index, value: weight });
            }
            let (s, c) = to_f64(angle.radians()).sin_cos();
            cos += weight * c;
            sin += weight * s;
            sum += weight;
        }
        if sum == 0.0 {
            return Err(GaussianError::NoWeight { count });
        }
        let moments = Self { cos: cos / sum, sin: sin / sum };
        if moments.resultant_length().is_finite() {
            Ok(moments)
        } else {
            Err(GaussianError::NotFinite { what: "angle" })
        }
    }

    /// $`\bar R`$: 1 when all directions agree, 0 when they cancel.
    pub fn resultant_length(&self) -> f64 {
        self.cos.hypot(self.sin)
    }
    /// $`1 - \bar R`$, in [0, 1].
    pub fn variance(&self) -> f64 {
        (1.0 - self.resultant_length()).max(0.0)
    }
    /// $`\sqrt{-2 \log \bar R}`$ radians; infinite when the directions cancel.
    pub fn standard_deviation(&self) -> f64 {
        (-2.0 * self.resultant_length().min(1.0).ln()).sqrt()
    }
    /// The mean direction; `None` if the directions cancel to within rounding.
    pub fn mean_direction(&self) -> Option<Angle<f64>> {
        (self.resultant_length() > 4.0 * f64::EPSILON).then(|| Angle::new(self.sin.atan2(self.cos)))
    }
}
