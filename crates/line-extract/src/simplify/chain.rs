use nalgebra::Vector2;

use crate::LineError;

/// Beyond this, metres, the product of two differences may overflow.
const LARGEST: f64 = 1e150;

/// Points and tolerance that were found usable.
pub(super) struct Chain<'a> {
    pub(super) points: &'a [Vector2<f64>],
    pub(super) epsilon: f64,
    /// Width and height of the whole.
    pub(super) extent: Vector2<f64>,
}

impl<'a> Chain<'a> {
    pub(super) fn new(points: &'a [Vector2<f64>], epsilon: f64) -> Result<Self, LineError> {
        if !(epsilon.is_finite() && epsilon >= 0.0) {
            return Err(LineError::Epsilon { value: epsilon });
        }
        Ok(Self { points, epsilon, extent: extent(points)? })
    }
}

fn extent(points: &[Vector2<f64>]) -> Result<Vector2<f64>, LineError> {
    let Some(first) = points.first() else { return Ok(Vector2::zeros()) };
    let (low, high) = points.iter().fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)));
    // Comparisons let a NaN slip through; a sum of products with zero keeps it.
    let poison: f64 = points.iter().map(|p| 0.0 * p.x + 0.0 * p.y).sum();
    let usable = poison == 0.0 && low.amax() <= LARGEST && high.amax() <= LARGEST;
    if usable { Ok(high - low) } else { Err(first_unusable(points)) }
}

fn first_unusable(points: &[Vector2<f64>]) -> LineError {
    let unusable = |p: &Vector2<f64>| !(p.x.abs() <= LARGEST && p.y.abs() <= LARGEST);
    let index = points.iter().position(unusable).unwrap_or(0);
    LineError::Point { index, x: points[index].x, y: points[index].y, largest: LARGEST }
}
