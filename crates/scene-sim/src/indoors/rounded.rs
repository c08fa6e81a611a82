use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

use crate::SimulationError;
use crate::route::{Route, RoutePiece};

/// Through points joined by right angles, with rounded corners.
pub(super) fn rounded(points: &[Vector2<f64>], radius: f64) -> Result<Route, SimulationError> {
    let mut pieces = Vec::with_capacity(2 * points.len());
    let mut trimmed = 0.0;
    for (k, ends) in points.windows(2).enumerate() {
        let side = ends[1] - ends[0];
        let next = points.get(k + 2).map(|point| point - ends[1]);
        let corner = if next.is_some() { radius } else { 0.0 };
        pieces.push(RoutePiece { length_m: side.norm() - trimmed - corner, curvature_per_m: 0.0 });
        if let Some(next) = next {
            let curvature_per_m = side.perp(&next).signum() / radius;
            pieces.push(RoutePiece { length_m: FRAC_PI_2 * radius, curvature_per_m });
        }
        trimmed = corner;
    }
    let first = points[1] - points[0];
    Route::open(Pose2::new(points[0].x, points[0].y, libm::atan2(first.y, first.x)), pieces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn it_ends_where_the_last_point_is() {
        let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (2.0, 5.0)].map(|(x, y)| Vector2::new(x, y));
        let route = rounded(&points, 0.8).unwrap();
        let end = route.at(route.length_m());
        assert_abs_diff_eq!(end.translation, points[3], epsilon = 1e-9);
        assert_abs_diff_eq!(route.length_m(), 23.0 - 2.0 * (2.0 - FRAC_PI_2) * 0.8, epsilon = 1e-9);
    }
}
