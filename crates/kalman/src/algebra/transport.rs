//! From the tangent space at the prediction to that at the corrected mean.

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc, TangentMatrix};
use wayfix_gaussian_core::{Gaussian, symmetrize};

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

/// The Gaussian at `mean` whose covariance in the tangent space at `from` is $`P`$: there it is $`J P J^T`$, positive definite.
pub(crate) fn gaussian_at<X: Manifold>(
    what: &'static str,
    mean: X,
    from: &X,
    mut covariance: TangentMatrix<X>,
) -> Checked<Gaussian<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    check::positive_definite(what, &covariance)?;
    if let Some(jacobian) = transport(from, &mean) {
        covariance = &jacobian * covariance * jacobian.transpose();
        symmetrize(&mut covariance);
        check::positive_definite(what, &covariance)?;
    }
    Ok(Gaussian::from_parts_unchecked(mean, covariance))
}
