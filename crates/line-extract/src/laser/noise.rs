use nalgebra::{Matrix2, Vector2};

/// Independent white noise on ranges and bearings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct RangeBearingNoise {
    /// Deviation of a range, metres.
    pub sigma_range_m: f64,
    /// Deviation of a beam's direction, radians.
    pub sigma_bearing_rad: f64,
}

impl Default for RangeBearingNoise {
    /// 1 cm and 0.002 rad.
    fn default() -> Self {
        Self { sigma_range_m: 0.01, sigma_bearing_rad: 0.002 }
    }
}

impl RangeBearingNoise {
    /// The covariance of an echo at `point` (sensor frame), m²: $`σ_r^2 u u^T + r^2 σ_b^2 (I - u u^T)`$ with $`u = p / r`$.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use wayfix_line_extract::RangeBearingNoise;
    ///
    /// let noise = RangeBearingNoise { sigma_range_m: 0.01, sigma_bearing_rad: 0.002 };
    /// let ahead = noise.covariance(&Vector2::new(10.0, 0.0));
    /// assert!((ahead[(0, 0)] - 1e-4).abs() < 1e-12 && (ahead[(1, 1)] - 4e-4).abs() < 1e-12);
    /// ```
    pub fn covariance(&self, point: &Vector2<f64>) -> Matrix2<f64> {
        let (along, across) = self.variances(point);
        let ray = point.try_normalize(0.0).unwrap_or_default();
        Matrix2::from_diagonal_element(across) + ray * ray.transpose() * (along - across)
    }

    /// The inverse variance of an echo along a unit normal, 1/m²; `point` is not the origin.
    #[inline]
    pub(super) fn weight(&self, point: &Vector2<f64>, normal: &Vector2<f64>) -> f64 {
        let (along, across) = self.variances(point);
        let squared = point.norm_squared();
        let depth = normal.dot(point);
        squared / (across * squared + (along - across) * depth * depth)
    }

    /// Along the ray and across it.
    #[inline]
    fn variances(&self, point: &Vector2<f64>) -> (f64, f64) {
        let across = self.sigma_bearing_rad * self.sigma_bearing_rad * point.norm_squared();
        (self.sigma_range_m * self.sigma_range_m, across)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_weight_is_the_inverse_of_the_covariance_along_the_normal() {
        let noise = RangeBearingNoise { sigma_range_m: 0.02, sigma_bearing_rad: 0.005 };
        for k in 0..50 {
            let point = Vector2::new(f64::from(k) - 20.0, 0.5 * f64::from(k) + 0.1);
            let normal = Vector2::new((0.3 * f64::from(k)).cos(), (0.3 * f64::from(k)).sin());
            let variance = normal.dot(&(noise.covariance(&point) * normal));
            assert_abs_diff_eq!(noise.weight(&point, &normal) * variance, 1.0, epsilon = 1e-9);
        }
    }
}
