use nalgebra::{ComplexField, Const, DefaultAllocator, Dim, OMatrix, allocator::Allocator};

use crate::{Jacobian, Manifold, Tangent, epsilon};

/// The central-difference derivative of `function` at `point`, in tangent coordinates.
///
/// $`J_{·i} = \big(f(x ⊞ h e_i) ⊟ f(x) \;-\; (f(x ⊞ -h e_i) ⊟ f(x))\big) / d`$ with $`h = ε^{1/3}`$, error about $`ε^{2/3}`$ (4e-11 for `f64`)
/// where function and derivatives are of order one; values of size $`s`$ add $`ε s / h`$.
///
/// $`d`$ is the step that rounding leaves of $`2h`$ beside the coordinate. Where it leaves less than half, $`h`$ is doubled until it does not.
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

/// Doublings of the step, up to a coordinate of the largest number in single precision.
const MOST_DOUBLINGS: usize = 140;

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
        let moved = |signed_step| {
            let mut delta = Tangent::<X>::zeros_generic(point.dim(), Const::<1>);
            delta[i] = signed_step;
            point.retract(&delta)
        };
        let mut step = step;
        let mut ends = [moved(-step), moved(step)];
        for _ in 0..MOST_DOUBLINGS {
            if ends[0].local(&ends[1])[i] >= step {
                break;
            }
            step += step;
            ends = [moved(-step), moved(step)];
        }
        let [before, after] = ends.each_ref().map(|end| value.local(&function(end)));
        let column = (after - before) / ends[0].local(&ends[1])[i];
        jacobian.set_column(i, &column);
    }
    jacobian
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use nalgebra::{Vector1, Vector2};

    use super::*;

    #[test]
    fn derivative_is_right_at_large_coordinates() {
        for offset in [0.0, 5e5, 4.6e6, 1.7e9, 1.7e12] {
            let beacon = Vector2::new(offset + 3.0, offset + 4.0);
            let range = |p: &Vector2<f64>| Vector1::new((p - beacon).norm());
            let jacobian = numerical_jacobian(range, &Vector2::new(offset, offset));
            assert!(
                abs_diff_eq!(jacobian[(0, 0)], -0.6, epsilon = 1e-4)
                    && abs_diff_eq!(jacobian[(0, 1)], -0.8, epsilon = 1e-4),
                "{offset}"
            );
        }
    }

    #[test]
    fn standing_still_has_the_identity_in_single_precision() {
        for offset in [0.0_f32, 1e3, 5e5, 4.6e6, 1e12] {
            let jacobian = numerical_jacobian(|p: &Vector2<f32>| *p, &Vector2::new(offset, -offset));
            assert!(
                abs_diff_eq!(jacobian, nalgebra::Matrix2::identity(), epsilon = 1e-6),
                "{offset}: {jacobian}"
            );
        }
    }
}
