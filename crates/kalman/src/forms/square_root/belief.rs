use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc, TangentMatrix};
use wayfix_gaussian_core::Gaussian;

/// A Gaussian carried as mean and lower triangular $`L`$ with $`P = L L^T`$.
#[derive(Clone, Debug, PartialEq)]
pub struct FactoredGaussian<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    pub(super) mean: X,
    pub(super) factor: TangentMatrix<X>,
}

impl<X: Manifold> FactoredGaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The mean.
    pub fn mean(&self) -> &X {
        &self.mean
    }
    /// $`L`$, with a positive diagonal.
    pub fn factor(&self) -> &TangentMatrix<X> {
        &self.factor
    }
    /// $`L L^T`$. Its variances are sums of squares and cannot be negative.
    pub fn covariance(&self) -> TangentMatrix<X> {
        &self.factor * self.factor.transpose()
    }
}

impl<X: Manifold> From<FactoredGaussian<X>> for Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    fn from(belief: FactoredGaussian<X>) -> Self {
        let covariance = belief.covariance();
        Self::from_parts_unchecked(belief.mean, covariance)
    }
}
