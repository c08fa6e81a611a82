use nalgebra::Vector2;

use crate::{LineExtractionError, check};

/// Beyond this, metres, the product of two differences may overflow.
const LARGEST: f64 = 1e150;

/// Validated points and tolerance.
pub(super) struct Chain<'a> {
    pub(super) points: &'a [Vector2<f64>],
    pub(super) epsilon: f64,
    /// Width and height of the whole.
    pub(super) extent: Vector2<f64>,
}

impl<'a> Chain<'a> {
    pub(super) fn new(points: &'a [Vector2<f64>], epsilon: f64) -> Result<Self, LineExtractionError> {
        if !(epsilon.is_finite() && epsilon >= 0.0) {
            return Err(LineExtractionError::Epsilon { value: epsilon });
        }
        Ok(Self { points, epsilon, extent: extent(points)? })
    }
}

fn extent(points: &[Vector2<f64>]) -> Result<Vector2<f64>, LineExtractionError> {
    check::points(points, LARGEST)?;
    let Some(first) = points.first() else { return Ok(Vector2::zeros()) };
    let (low, high) = points.iter().fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)));
    Ok(high - low)
}
