use nalgebra::{DefaultAllocator, Dim, OMatrix};
use wayfix_estimation_traits::{Manifold, StateAlloc, TangentMatrix};

use crate::GaussianError;

/// A normal distribution over any manifold: $`x ∼ μ ⊞ N(0, Σ)`$.
///
/// The covariance lives in the tangent space at the mean (body frame for poses).
/// Covariances are symmetric positive definite when they come in; singular ones are refused.
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
    /// $`N(\text{mean}, \text{covariance})`$, checked.
    ///
    /// # Errors
    /// When the covariance has the wrong size, is not finite, not symmetric or not positive definite.
    pub fn new(mean: X, covariance: TangentMatrix<X>) -> Result<Self, GaussianError> {
        let (expected, got) = (mean.dim().value(), covariance.nrows());
        if expected != got {
            return Err(GaussianError::Dimension { what: "covariance", expected, got });
        }
        Ok(Self { mean, covariance })
    }
    /// The mean $`μ`$.
    pub fn mean(&self) -> &X {
        &self.mean
    }
    /// The covariance $`Σ`$ in the tangent space at the mean.
    pub fn covariance(&self) -> &OMatrix<X::Scalar, X::Dim, X::Dim> {
        &self.covariance
    }
    /// The two parts.
    pub fn into_parts(self) -> (X, TangentMatrix<X>) {
        (self.mean, self.covariance)
    }
}
