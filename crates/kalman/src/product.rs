//! Covariance algebra that every form shares.

use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};
use wayfix_estimation_traits::UpdateAlloc;
use wayfix_gaussian_core::symmetrize;

use crate::{check, error::Checked};

/// $`F P F^T + Q`$, positive definite.
pub(crate) fn propagated_covariance<T, D>(
    jacobian: &OMatrix<T, D, D>,
    covariance: &OMatrix<T, D, D>,
    noise: &OMatrix<T, D, D>,
) -> Checked<OMatrix<T, D, D>>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let mut predicted = jacobian * covariance * jacobian.transpose() + noise;
    symmetrize(&mut predicted);
    check::positive_definite("predicted", &predicted)?;
    Ok(predicted)
}

/// $`(I - KH) P (I - KH)^T + K R K^T`$, positive definite: the form of Joseph, right for any gain and kind to rounding.
pub(crate) fn joseph<T, D, M>(
    prior: &OMatrix<T, D, D>,
    gain: &OMatrix<T, D, M>,
    jacobian: &OMatrix<T, M, D>,
    noise: &OMatrix<T, M, M>,
) -> Checked<OMatrix<T, D, D>>
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: UpdateAlloc<D, M>,
{
    let (n, _) = prior.shape_generic();
    let remainder = OMatrix::identity_generic(n, n) - gain * jacobian;
    let mut posterior = &remainder * prior * remainder.transpose() + gain * noise * gain.transpose();
    symmetrize(&mut posterior);
    check::positive_definite("posterior", &posterior)?;
    Ok(posterior)
}

/// $`P - K C^T`$, positive definite or refused: the textbook difference, half the work of [`joseph`] and less forgiving.
pub(crate) fn plain_difference<T, D, M>(
    prior: &OMatrix<T, D, D>,
    gain: &OMatrix<T, D, M>,
    cross_covariance: &OMatrix<T, D, M>,
) -> Checked<OMatrix<T, D, D>>
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: UpdateAlloc<D, M>,
{
    let mut posterior = prior - gain * cross_covariance.transpose();
    symmetrize(&mut posterior);
    check::positive_definite("posterior", &posterior)?;
    Ok(posterior)
}
