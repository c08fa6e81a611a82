use nalgebra::{ComplexField, Const, DefaultAllocator, Dim, OMatrix, allocator::Allocator};

use crate::{Jacobian, Manifold, Tangent, epsilon};

/// The central-difference derivative of `function` at `point`, in tangent coordinates.
///
/// $`J_{·i} = \big(f(x ⊞ h e_i) ⊟ f(x) \;-\; (f(x ⊞ -h e_i) ⊟ f(x))\big) / 2h`$ with $`h = ε^{1/3}`$, error about $`ε^{2/3}`$ (4e-11 for `f64`)
/// where function and derivatives are of order one; values of size $`s`$ add $`ε s / h`$.
///
/// ```
/// use nalgebra::{Vector1, Vector2};
/// use wayfix_estimation_traits::numerical_jacobian;
/// let range = |p: &Vector2<f64>| Vector1::new(p.norm());
/// let jacobian = numerical_jacobian(range, &Vector2::new(3.0, 4.0));
/// assert!((jacobian[(0, 0)] - 0.6).abs() < 1e-9 && (jacobian[(0, 1)] - 0.8).abs() < 1e-9);
/// ```
pub fn numerical_jacobian<X, Z>(function: impl Fn(&X) -> Z, point: &X) -> Jacobian<Z, X>
where
    X: Manifold,
    Z: Manifold<Scalar = X::Scalar>,
    DefaultAllocator: Allocator<X::Dim> + Allocator<Z::Dim> + Allocator<Z::Dim, X::Dim>,
{
    central_difference(function, point, epsilon::<X::Scalar>().cbrt())
}

/// [`numerical_jacobian`] with a step of the caller's.
pub(crate) fn central_difference<X, Z>(
    function: impl Fn(&X) -> Z,
    point: &X,
    step: X::Scalar,
) -> Jacobian<Z, X>
where
    X: Manifold,
    Z: Manifold<Scalar = X::Scalar>,
    DefaultAllocator: Allocator<X::Dim> + Allocator<Z::Dim> + Allocator<Z::Dim, X::Dim>,
{
    let value = function(point);
    let mut jacobian = OMatrix::zeros_generic(value.dim(), point.dim());
    for i in 0..point.dim().value() {
        let difference = |signed_step| {
            let mut delta = Tangent::<X>::zeros_generic(point.dim(), Const::<1>);
            delta[i] = signed_step;
            value.local(&function(&point.retract(&delta)))
        };
        let column = (difference(step) - difference(-step)) / (step + step);
        jacobian.set_column(i, &column);
    }
    jacobian
}
