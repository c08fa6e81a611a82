use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::{Jacobian, Manifold, UpdateAlloc};

use crate::{Gaussian, GaussianError, gaussian::check_dimension};

impl<T: RealField + Copy, D: Dim> Gaussian<OVector<T, D>>
where
    DefaultAllocator: wayfix_estimation_traits::StateAlloc<D>,
{
    /// $`y = A x + b ∼ N(A μ + b,\; A Σ A^T)`$.
    ///
    /// ```
    /// use nalgebra::{Matrix2, RowVector2, Vector1, Vector2};
    /// use wayfix_gaussian_core::Gaussian;
    /// let both = Gaussian::new(Vector2::new(1.0, 2.0), Matrix2::new(1.0, 0.5, 0.5, 1.0))?;
    /// let sum = both.affine(&RowVector2::new(1.0, 1.0), &Vector1::new(10.0))?;
    /// assert_eq!((sum.mean()[0], sum.covariance()[(0, 0)]), (13.0, 3.0));
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if sizes differ, something is not finite, or $`A`$ has dependent rows so that the result is flat.
    pub fn affine<M: Dim>(
        &self,
        matrix: &OMatrix<T, M, D>,
        offset: &OVector<T, M>,
    ) -> Result<Gaussian<OVector<T, M>>, GaussianError>
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        check_dimension("columns of the matrix", self.mean().len(), matrix.ncols())?;
        check_dimension("offset", matrix.nrows(), offset.len())?;
        Gaussian::new(matrix * self.mean() + offset, matrix * self.covariance() * matrix.transpose())
    }
}

impl<X: Manifold> Gaussian<X>
where
    DefaultAllocator: wayfix_estimation_traits::StateAlloc<X::Dim>,
{
    /// The Gaussian of $`f(x)`$ to first order: $`N(f(μ),\; J Σ J^T)`$.
    ///
    /// `jacobian` is $`∂(f(μ ⊞ δ) ⊟ f(μ))/∂δ`$; [`numerical_jacobian`](wayfix_estimation_traits::numerical_jacobian) gives one.
    ///
    /// ```
    /// use nalgebra::{Matrix1, Vector1};
    /// use wayfix_gaussian_core::Gaussian;
    /// let side = Gaussian::from_sigmas(Vector1::new(3.0), &Vector1::new(0.1))?;
    /// let area = side.linearized(|x| x.component_mul(x), &Matrix1::new(6.0))?;
    /// assert!((area.covariance()[(0, 0)] - 0.36_f64).abs() < 1e-15);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if sizes differ, something is not finite, or the Jacobian has dependent rows so that the result is flat.
    pub fn linearized<Z>(
        &self,
        function: impl FnOnce(&X) -> Z,
        jacobian: &Jacobian<Z, X>,
    ) -> Result<Gaussian<Z>, GaussianError>
    where
        Z: Manifold<Scalar = X::Scalar>,
        DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
    {
        check_dimension("columns of the Jacobian", self.dim().value(), jacobian.ncols())?;
        Gaussian::new(function(self.mean()), jacobian * self.covariance() * jacobian.transpose())
    }
}
