use nalgebra::{Matrix2, RealField, Vector2};

use crate::{GaussianError, check_covariance};

/// The curve of equal density of a planar Gaussian.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use wayfix_gaussian_core::CovarianceEllipse;
/// let ellipse = CovarianceEllipse::at_sigmas(&Matrix2::new(1.0_f64, 0.0, 0.0, 4.0), 2.0)?;
/// assert_eq!((ellipse.semi_major, ellipse.semi_minor), (4.0, 2.0));
/// assert!((ellipse.angle.abs() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// assert_eq!(ellipse.polyline(&Vector2::new(1.0, 1.0), 32).len(), 33); // closed
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CovarianceEllipse<T> {
    /// The longer half axis.
    pub semi_major: T,
    /// The shorter half axis.
    pub semi_minor: T,
    /// Direction of the longer axis from the x axis, radians in (−π/2, π/2].
    pub angle: T,
}

impl<T: RealField + Copy> CovarianceEllipse<T> {
    /// The ellipse `sigmas` standard deviations out.
    ///
    /// # Errors
    /// Returns an error if the covariance is not symmetric positive definite or `sigmas` is not positive and finite.
    pub fn at_sigmas(covariance: &Matrix2<T>, sigmas: f64) -> Result<Self, GaussianError> {
        check_covariance("ellipse", covariance)?;
        if !(sigmas > 0.0 && sigmas.is_finite()) {
            return Err(GaussianError::Parameter {
                what: "sigmas",
                value: sigmas,
                range: "positive and finite",
            });
        }
        let (half, k): (T, T) = (nalgebra::convert(0.5), nalgebra::convert(sigmas));
        let (a, b, d) = (covariance.m11, covariance.m12, covariance.m22);
        let larger = (a + d) * half + ((a - d) * half).hypot(b);
        // The smaller eigenvalue from the determinant: as a difference it would lose its digits.
        let smaller = (a * (d / larger) - b * (b / larger)).max(T::zero());
        Ok(Self {
            semi_major: larger.sqrt() * k,
            semi_minor: smaller.sqrt() * k,
            angle: (b + b).atan2(a - d) * half,
        })
    }

    /// A closed polyline of `segments` chords round `centre`: the last point is the first.
    pub fn polyline(&self, centre: &Vector2<T>, segments: usize) -> Vec<Vector2<T>> {
        let (sin, cos) = self.angle.sin_cos();
        let point = |i: usize| {
            let turn: T =
                T::two_pi() * nalgebra::convert((i % segments.max(1)) as f64 / segments.max(1) as f64);
            let (u, v) = (self.semi_major * turn.cos(), self.semi_minor * turn.sin());
            centre + Vector2::new(u * cos - v * sin, u * sin + v * cos)
        };
        (0..=segments).map(point).collect()
    }
}
