use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};

use crate::{Manifold, epsilon, laws::LawViolation, to_f64};

/// Fails if `error` is above `tolerance` or not a number; for law suites of your own.
///
/// # Errors
/// The violation of `law` in that `case`.
pub fn within(
    law: &'static str,
    error: f64,
    tolerance: f64,
    case: impl FnOnce() -> String,
) -> Result<(), LawViolation> {
    if error <= tolerance { Ok(()) } else { Err(LawViolation { law, case: case(), error, tolerance }) }
}

/// Fails when an entry is NaN or infinite.
pub(super) fn finite<T: RealField + Copy>(
    law: &'static str,
    entries: &[T],
    case: impl FnOnce() -> String,
) -> Result<(), LawViolation> {
    let bad = entries.iter().position(|entry| !entry.is_finite());
    within(law, if bad.is_some() { f64::NAN } else { 0.0 }, 0.0, case)
}

/// How far two points are apart, as seen from the first.
pub(super) fn distance<X: Manifold>(a: &X, b: &X) -> f64
where
    DefaultAllocator: Allocator<X::Dim>,
{
    to_f64(a.local(b).norm())
}

/// The largest distance between two of the points, at least 1: coordinates of that size round by ε times it.
pub(super) fn extent<X: Manifold>(points: &[X]) -> f64
where
    DefaultAllocator: Allocator<X::Dim>,
{
    let pairs = points.iter().flat_map(|a| points.iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| distance(a, b)).fold(1.0, f64::max)
}

/// Some thousand roundings at the given size: a composed rigid motion is some hundred operations.
pub(super) fn rounding<T: RealField>(size: f64) -> f64 {
    1e3 * to_f64(epsilon::<T>()) * size
}

/// The smallest eigenvalue must not be below `-slack`, symmetry within `slack`. Tried by a Cholesky factorization of the shifted matrix.
pub(super) fn positive<T, D>(
    law: &'static str,
    matrix: &OMatrix<T, D, D>,
    strictly: bool,
    case: impl Fn() -> String,
) -> Result<(), LawViolation>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    finite(law, matrix.as_slice(), &case)?;
    let size = to_f64(matrix.amax());
    let slack = rounding::<T>(size);
    within(law, to_f64((matrix - matrix.transpose()).amax()), slack, &case)?;
    if !strictly && size == 0.0 {
        return Ok(());
    }
    let mut shifted = matrix.clone();
    if !strictly {
        for i in 0..shifted.nrows() {
            shifted[(i, i)] += nalgebra::convert(slack);
        }
    }
    let factored = nalgebra::linalg::Cholesky::new(shifted).is_some();
    within(law, if factored { 0.0 } else { f64::INFINITY }, 0.0, case)
}
