use nalgebra::Vector2;

use crate::LineExtractionError;

/// Names the first point with a coordinate that is not within ± `largest`.
pub(crate) fn points(points: &[Vector2<f64>], largest: f64) -> Result<(), LineExtractionError> {
    let usable = |p: &Vector2<f64>| p.x.abs() <= largest && p.y.abs() <= largest;
    match points.iter().position(|p| !usable(p)) {
        Some(index) => {
            Err(LineExtractionError::Point { index, x: points[index].x, y: points[index].y, largest })
        }
        None => Ok(()),
    }
}
