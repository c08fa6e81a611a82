use nalgebra::{Const, DefaultAllocator, Dim, allocator::Allocator};

use crate::{Manifold, Tangent};

/// Lengths every suite tries: zero, below the square root of rounding, small, middling, almost half a turn.
pub(super) const LENGTHS: [f64; 5] = [0.0, 1e-8, 1e-3, 0.5, 3.0];

/// Tangents at `point` of the given lengths: each axis alone and three mixtures, in both signs.
pub(super) fn tangents<X: Manifold>(point: &X, lengths: &[f64]) -> Vec<Tangent<X>>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    let n = point.dim().value();
    let axis = |k: usize| move |i: usize| if i == k { 1.0 } else { 0.0 };
    let mut directions: Vec<Tangent<X>> = (0..n).map(|k| direction(point, axis(k))).collect();
    directions.push(direction(point, |_| 1.0));
    directions.push(direction(point, |i| if i % 2 == 0 { 1.0 } else { -1.0 }));
    directions.push(direction(point, |i| (i as f64 + 1.0) * if i % 3 == 0 { -1.0 } else { 1.0 }));
    let signed = |length: &f64| [*length, -*length];
    let scaled =
        |length: f64| directions.iter().map(move |d| d * nalgebra::convert::<f64, X::Scalar>(length));
    lengths.iter().flat_map(signed).flat_map(scaled).collect()
}

fn direction<X: Manifold>(point: &X, entry: impl Fn(usize) -> f64) -> Tangent<X>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    let n = point.dim().value();
    let norm = (0..n).map(|i| entry(i).powi(2)).sum::<f64>().sqrt();
    Tangent::<X>::from_fn_generic(point.dim(), Const::<1>, |i, _| nalgebra::convert(entry(i) / norm.max(1.0)))
}
