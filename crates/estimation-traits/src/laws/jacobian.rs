use nalgebra::{DefaultAllocator, allocator::Allocator};

use super::{
    LawViolation,
    check::{finite, within},
};
use crate::{Jacobian, Manifold, derivative::central_difference, epsilon, to_f64};

/// Whether `claimed` is the derivative of `function` at `point`.
///
/// Two central differences, one step twice the other, give an estimate of their own error by their difference; coordinates of the given
/// `size` add their rounding over the step.
pub(super) fn agrees<X, Z>(
    law: &'static str,
    claimed: &Jacobian<Z, X>,
    function: impl Fn(&X) -> Z,
    point: &X,
    size: f64,
    case: impl Fn() -> String,
) -> Result<(), LawViolation>
where
    X: Manifold,
    Z: Manifold<Scalar = X::Scalar>,
    DefaultAllocator: Allocator<X::Dim> + Allocator<Z::Dim> + Allocator<Z::Dim, X::Dim>,
{
    finite(law, claimed.as_slice(), &case)?;
    let unit = to_f64(epsilon::<X::Scalar>());
    let step = unit.cbrt();
    let fine = central_difference(&function, point, nalgebra::convert(step));
    let coarse = central_difference(&function, point, nalgebra::convert(2.0 * step));
    // The truncation h² f'''/6 is a third of the difference; ten times leaves room for rounding that happens to agree.
    let scale = size + to_f64(fine.amax());
    let tolerance = 10.0 * to_f64((&coarse - &fine).amax()) + 100.0 * (step * step + unit / step) * scale;
    let shape_fits = claimed.shape() == fine.shape();
    let error = if shape_fits { to_f64((claimed - fine).amax()) } else { f64::INFINITY };
    within(law, error, tolerance, case)
}
