//! From the tangent space at the prediction to that at the corrected mean.

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc, TangentMatrix};
use wayfix_gaussian_core::symmetrize;

use crate::{check, error::Checked};

/// The matrix that carries tangents from `from` to `to`, or `None` where it is the identity (everywhere on flat spaces).
///
/// A correction that turns the heading turns the body frame that the covariance is written in.
pub(crate) fn transport<X: Manifold>(from: &X, to: &X) -> Option<TangentMatrix<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let jacobian = from.chart_jacobian(to);
    let identity = TangentMatrix::<X>::identity_generic(from.dim(), from.dim());
    (jacobian != identity).then_some(jacobian)
}

/// $`J P J^T`$ at `to`, positive definite.
pub(crate) fn transported<X: Manifold>(
    covariance: TangentMatrix<X>,
    from: &X,
    to: &X,
) -> Checked<TangentMatrix<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let Some(jacobian) = transport(from, to) else { return Ok(covariance) };
    let mut there = &jacobian * covariance * jacobian.transpose();
    symmetrize(&mut there);
    check::positive_definite("posterior", &there)?;
    Ok(there)
}
