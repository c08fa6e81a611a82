use nalgebra::{ComplexField, Const, DefaultAllocator, Dim, RealField};
use wayfix_estimation_traits::{Manifold, StateAlloc, Tangent, TangentMatrix, to_f64};

use crate::{GaussianError, check_covariance, symmetrize};

/// A normal distribution over any manifold: $`x ∼ μ ⊞ N(0, Σ)`$.
///
/// The covariance is in the tangent space at the mean (body frame for poses).
/// Constructors refuse covariances that are not symmetric positive definite, singular ones included.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let belief = Gaussian::from_sigmas(Pose2::<f64>::new(1.0, 2.0, 0.5), &Vector3::new(0.1, 0.1, 0.02))?;
/// assert!((belief.covariance()[(2, 2)] - 0.0004).abs() < 1e-15);
/// assert_eq!(belief.mean().heading(), 0.5);
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Gaussian<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    mean: X,
    covariance: TangentMatrix<X>,
}

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// $`N(\text{mean}, \text{covariance})`$, checked by [`check_covariance`] and made exactly symmetric.
    ///
    /// # Errors
    /// Returns an error if the mean is not finite, or the covariance has the wrong size, is not finite, not symmetric or not positive definite.
    pub fn new(mean: X, mut covariance: TangentMatrix<X>) -> Result<Self, GaussianError> {
        check_dimension("covariance", mean.dim().value(), covariance.nrows())?;
        check_mean(&mean)?;
        check_covariance("given", &covariance)?;
        symmetrize(&mut covariance);
        Ok(Self { mean, covariance })
    }

    /// $`N(\text{mean}, \text{covariance})`$, unchecked: for inner loops whose algebra keeps covariances symmetric positive definite.
    ///
    /// The caller guarantees the conditions of [`new`](Self::new). If they are violated, nothing is unsafe or panics: later operations that
    /// factor the covariance return an error, and samples are drawn from its positive part.
    pub fn from_parts_unchecked(mean: X, covariance: TangentMatrix<X>) -> Self {
        Self { mean, covariance }
    }

    /// Independent standard deviations, in the units of the tangent space.
    ///
    /// # Errors
    /// Returns an error if the mean is not finite, or a sigma is not finite or not positive.
    pub fn from_sigmas(mean: X, sigmas: &Tangent<X>) -> Result<Self, GaussianError> {
        check_dimension("sigmas", mean.dim().value(), sigmas.nrows())?;
        // A negative sigma squares to a valid variance, so it has to be caught here.
        if let Some(pivot) = sigmas.iter().position(|sigma| *sigma <= nalgebra::zero()) {
            let value = to_f64(sigmas[pivot]);
            return Err(GaussianError::NotPositiveDefinite { what: "sigma of the", pivot, value });
        }
        let variances = sigmas.component_mul(sigmas);
        Self::new(mean, TangentMatrix::<X>::from_diagonal(&variances))
    }

    /// The mean $`μ`$.
    pub fn mean(&self) -> &X {
        &self.mean
    }
    /// The covariance $`Σ`$ in the tangent space at the mean.
    pub fn covariance(&self) -> &TangentMatrix<X> {
        &self.covariance
    }
    /// Dimension of the tangent space.
    pub fn dim(&self) -> X::Dim {
        self.mean.dim()
    }
    /// Standard deviations along the tangent axes.
    pub fn sigmas(&self) -> Tangent<X> {
        Tangent::<X>::from_fn_generic(self.dim(), Const::<1>, |i, _| {
            // A variance rounded below zero in an unchecked covariance must not become NaN.
            self.covariance[(i, i)].max(nalgebra::zero()).sqrt()
        })
    }
    /// The two parts.
    pub fn into_parts(self) -> (X, TangentMatrix<X>) {
        (self.mean, self.covariance)
    }
}

pub(crate) fn check_dimension(what: &'static str, expected: usize, got: usize) -> Result<(), GaussianError> {
    if expected == got { Ok(()) } else { Err(GaussianError::Dimension { what, expected, got }) }
}

/// The distance of a non-finite point to itself is NaN.
fn check_mean<X: Manifold>(mean: &X) -> Result<(), GaussianError>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let finite = mean.local(mean).iter().all(ComplexField::is_finite);
    if finite { Ok(()) } else { Err(GaussianError::NotFinite { what: "mean" }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};
    use wayfix_estimation_traits::{Angle, Pose2};

    #[test]
    fn hostile_parts_are_refused_with_a_reason() {
        let mean = Vector2::new(1.0, 2.0);
        assert!(Gaussian::new(Vector2::new(f64::NAN, 0.0), Matrix2::identity()).is_err());
        assert!(Gaussian::new(Vector2::new(f64::INFINITY, 0.0), Matrix2::identity()).is_err());
        assert!(Gaussian::new(Pose2::new(0.0, 0.0, f64::NAN), Matrix3::identity()).is_err());
        assert!(Gaussian::new(Angle::new(f64::INFINITY), nalgebra::Matrix1::identity()).is_err());
        assert!(Gaussian::new(mean, -Matrix2::identity()).is_err());
        assert!(Gaussian::from_sigmas(mean, &Vector2::new(1.0, -1.0)).is_err());
        assert!(Gaussian::from_sigmas(mean, &Vector2::new(1.0, f64::NAN)).is_err());
        assert_eq!(
            Gaussian::new(DVector::from_element(3, 0.0), DMatrix::identity(2, 2)),
            Err(GaussianError::Dimension { what: "covariance", expected: 3, got: 2 })
        );
    }

    #[test]
    fn single_precision_passes_with_its_own_rounding() {
        let covariance = Matrix2::new(1.0_f32, 0.5, 0.5 + 1e-6, 1.0);
        let gaussian = Gaussian::new(Vector2::<f32>::zeros(), covariance).unwrap();
        assert_eq!(gaussian.covariance()[(0, 1)], gaussian.covariance()[(1, 0)]);
    }
}
