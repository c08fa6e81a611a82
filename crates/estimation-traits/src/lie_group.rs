use nalgebra::{DefaultAllocator, allocator::Allocator};

use crate::{Manifold, StateAlloc, Tangent, TangentMatrix, numerical_jacobian};

/// A manifold whose points compose.
///
/// **Laws**, for all $`g, h, k`$ and tangents $`ξ`$:
///
/// 1. group: $`g (h k) = (g h) k`$, $`g e = e g = g`$, $`g g^{-1} = e`$,
/// 2. one-parameter subgroup: $`\exp(sξ) \exp(tξ) = \exp((s+t)ξ)`$ for both signs of $`s`$ and $`t`$,
/// 3. $`\log \exp ξ = ξ`$ within the injectivity radius and $`\exp \log g = g`$,
/// 4. adjoint: $`g \exp(ξ) g^{-1} = \exp(\mathrm{Ad}_g ξ)`$,
/// 5. the exponential is tangent to the retraction: $`e ⊞ ξ = \exp(ξ) + O(ξ^2)`$,
/// 6. [`log_jacobian`](Self::log_jacobian) is the derivative it says it is.
///
/// [`laws::lie_group`](crate::laws::lie_group) checks them, for negative angles too: a published exponential of SE(2) was wrong for
/// every negative angle because its suite sampled positive ones only.
pub trait LieGroup: Manifold {
    /// The neutral element $`e`$.
    fn identity() -> Self;
    /// $`g h`$: first `other` in the frame of `self`.
    fn compose(&self, other: &Self) -> Self;
    /// $`g^{-1}`$.
    fn inverse(&self) -> Self;
    /// The group exponential: constant body velocity `tangent` for unit time.
    fn exp(tangent: &Tangent<Self>) -> Self
    where
        DefaultAllocator: Allocator<Self::Dim>;
    /// The group logarithm, inverse of [`exp`](Self::exp).
    fn log(&self) -> Tangent<Self>
    where
        DefaultAllocator: Allocator<Self::Dim>;
    /// $`\mathrm{Ad}_g`$: moves a tangent from the body frame to the frame of the identity.
    fn adjoint(&self) -> TangentMatrix<Self>
    where
        DefaultAllocator: Allocator<Self::Dim, Self::Dim>;
    /// $`J_r^{-1}(\log g) = ∂ \log(g \exp δ) / ∂δ`$ at $`δ = 0`$: the inverse of the right Jacobian. By default a central difference.
    /// [Solà et al. 2018, Eq. 79]
    fn log_jacobian(&self) -> TangentMatrix<Self>
    where
        DefaultAllocator: StateAlloc<Self::Dim>,
    {
        numerical_jacobian(Self::log, self)
    }
}
