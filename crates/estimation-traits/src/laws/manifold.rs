use nalgebra::{DefaultAllocator, Dim};

use super::{
    LawViolation,
    check::{distance, extent, finite, rounding, within},
    jacobian::agrees,
    tangents::{LENGTHS, tangents},
};
use crate::{Manifold, StateAlloc, to_f64};

/// The laws of [`Manifold`], at each of `points` and between each pair.
///
/// Choose points at the identity, far away, and on both sides of a wrap. Tangents are zero and $`±10^{-8}, ±10^{-3}, ±0.5, ±3`$ long, along each
/// axis and mixed; law 3 goes 10 and 1000 far. Errors may be $`10^3 ε`$ times the largest distance between two points, so put one near
/// the origin among points far away.
///
/// ```
/// use wayfix_estimation_traits::{Angle, laws};
/// laws::manifold(&[Angle::new(0.0), Angle::new(3.1), Angle::new(-3.1)])?;
/// # Ok::<(), laws::LawViolation>(())
/// ```
///
/// # Errors
/// The first law that does not hold.
pub fn manifold<X: Manifold>(points: &[X]) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let extent = extent(points);
    let tolerance = rounding::<X::Scalar>(extent);
    for (index, x) in points.iter().enumerate() {
        for delta in tangents(x, &LENGTHS) {
            let case = || format!("at point {index}, tangent {:?}", delta.as_slice());
            let moved = x.retract(&delta);
            let back = x.local(&moved);
            finite("both are finite (law 4)", back.as_slice(), case)?;
            within("dim does not change (law 4)", changed(x, &moved), 0.0, case)?;
            if delta.norm() == nalgebra::zero() {
                within("x ⊞ 0 = x (law 1)", distance(x, &moved), tolerance, case)?;
            }
            within("(x ⊞ δ) ⊟ x = δ (law 2)", to_f64((back - &delta).norm()), tolerance, case)?;
            within("x ⊞ (y ⊟ x) = y (law 3)", missed(x, &moved), tolerance, case)?;
        }
        for delta in tangents(x, &[10.0, 1000.0]) {
            let y = x.retract(&delta);
            let tolerance = rounding::<X::Scalar>(extent.max(1000.0));
            within("x ⊞ (y ⊟ x) = y (law 3)", missed(x, &y), tolerance, || {
                format!("at point {index}, y at tangent {:?}", delta.as_slice())
            })?;
        }
        for (other, y) in points.iter().enumerate() {
            let case = || format!("from point {index} to point {other}");
            within("x ⊞ (y ⊟ x) = y (law 3)", missed(x, y), tolerance, case)?;
            // The derivative exists away from the cut locus, which tangents shorter than 1 do not reach.
            for delta in tangents(x, &[1e-3, 0.5]) {
                let near = x.retract(&delta);
                agrees(
                    "chart_jacobian is the derivative (law 5)",
                    &near.chart_jacobian(x),
                    |p| x.local(p),
                    &near,
                    extent,
                    case,
                )?;
            }
        }
    }
    Ok(())
}

/// A manifold that closes on itself: going `period` along `axis` leads back.
///
/// A bearing that does not wrap obeys every other law, as a number on the line; this law distinguishes it from an angle.
///
/// ```
/// use wayfix_estimation_traits::{Pose2, laws};
/// laws::periodic(&[Pose2::new(1.0, 2.0, 3.0)], 2, std::f64::consts::TAU)?;
/// # Ok::<(), laws::LawViolation>(())
/// ```
///
/// # Errors
/// When it does not.
pub fn periodic<X: Manifold>(points: &[X], axis: usize, period: f64) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let tolerance = rounding::<X::Scalar>(extent(points));
    for (index, x) in points.iter().enumerate() {
        for turns in [1.0, -1.0, 3.0] {
            let mut delta = tangents(x, &[0.0]).swap_remove(0);
            if let Some(entry) = delta.get_mut(axis) {
                *entry = nalgebra::convert(turns * period);
            }
            within("x ⊞ period = x", distance(x, &x.retract(&delta)), tolerance, || {
                format!("at point {index}, axis {axis}, {turns} periods")
            })?;
        }
    }
    Ok(())
}

fn missed<X: Manifold>(x: &X, y: &X) -> f64
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    distance(y, &x.retract(&x.local(y)))
}

fn changed<X: Manifold>(x: &X, y: &X) -> f64 {
    x.dim().value().abs_diff(y.dim().value()) as f64
}
