use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField, allocator::Allocator};

use crate::{StateAlloc, numerical_jacobian};

/// A tangent vector of `X`.
pub type Tangent<X> = OVector<<X as Manifold>::Scalar, <X as Manifold>::Dim>;

/// A matrix on the tangent space of `X`: a covariance, an information matrix, a transition Jacobian.
pub type TangentMatrix<X> = OMatrix<<X as Manifold>::Scalar, <X as Manifold>::Dim, <X as Manifold>::Dim>;

/// The derivative of a function from `X` to `Z` in tangent coordinates: `dim Z × dim X`.
pub type Jacobian<Z, X> = OMatrix<<X as Manifold>::Scalar, <Z as Manifold>::Dim, <X as Manifold>::Dim>;

/// A set of points that is locally like a vector space around each of them.
///
/// Writing $`x ⊞ δ`$ for [`retract`](Self::retract) and $`y ⊟ x`$ for `x.local(&y)`, the **laws** are
///
/// 1. $`x ⊞ 0 = x`$,
/// 2. $`(x ⊞ δ) ⊟ x = δ`$ for every δ shorter than the injectivity radius (π for angles),
/// 3. $`x ⊞ (y ⊟ x) = y`$ for every $`y`$,
/// 4. both are finite for finite arguments, and `dim` does not change under `retract`,
/// 5. [`chart_jacobian`](Self::chart_jacobian) is the derivative it says it is.
///
/// [`laws::manifold`](crate::laws::manifold) checks them. Vectors (static and dynamic), [`Angle`](crate::Angle),
/// [`Pose2`](crate::Pose2) and [`Pose3`](crate::Pose3) implement it. [Hertzberg et al. 2013, Def. 1]
pub trait Manifold: Clone {
    /// `f64` or `f32`.
    type Scalar: RealField + Copy;
    /// Dimension of the tangent space; `Dyn` when it is only known at run time.
    type Dim: Dim;
    /// Tangent dimension of this very value.
    fn dim(&self) -> Self::Dim;
    /// $`x ⊞ δ`$: the point reached from here along the tangent vector `delta`.
    fn retract(&self, delta: &Tangent<Self>) -> Self
    where
        DefaultAllocator: Allocator<Self::Dim>;
    /// $`y ⊟ x`$: the tangent vector that leads from here to `other`.
    fn local(&self, other: &Self) -> Tangent<Self>
    where
        DefaultAllocator: Allocator<Self::Dim>;

    /// $`∂ \big((x ⊞ δ) ⊟ y\big) / ∂δ`$ at $`δ = 0`$ with $`y`$ = `at`: carries a covariance at $`x`$ to the tangent space at $`y`$.
    ///
    /// The identity for $`y = x`$ and on flat spaces. By default a central difference.
    fn chart_jacobian(&self, at: &Self) -> TangentMatrix<Self>
    where
        DefaultAllocator: StateAlloc<Self::Dim>,
    {
        numerical_jacobian(|x: &Self| at.local(x), self)
    }
}

/// Vectors are the flat manifold: $`x ⊞ δ = x + δ`$.
impl<T: RealField + Copy, D: Dim> Manifold for OVector<T, D>
where
    DefaultAllocator: Allocator<D>,
{
    type Scalar = T;
    type Dim = D;
    fn dim(&self) -> D {
        self.shape_generic().0
    }
    fn retract(&self, delta: &OVector<T, D>) -> Self {
        self + delta
    }
    fn local(&self, other: &Self) -> OVector<T, D> {
        other - self
    }
    fn chart_jacobian(&self, _: &Self) -> OMatrix<T, D, D>
    where
        DefaultAllocator: StateAlloc<D>,
    {
        OMatrix::identity_generic(self.dim(), self.dim())
    }
}
