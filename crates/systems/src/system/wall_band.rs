use nalgebra::{Matrix2, Vector2};
use wayfix_line_extract::{HessianLine, LineEstimate};

/// Standard deviations from the wall to the edge of its band.
const SIGMAS: f64 = 2.0;
/// Pieces of an edge, which is a hyperbola.
const N_PIECES: u32 = 8;

/// Outline of the 2σ band of a wall between two points that are `stretch` metres along it from the point that the covariance of its $`(ρ, α)`$ is about.
pub(crate) fn wall_band(
    [start, end]: [Vector2<f64>; 2],
    [from, to]: [f64; 2],
    covariance: Matrix2<f64>,
) -> Vec<(f64, f64)> {
    let wall = end - start;
    let normal = Vector2::new(-wall.y, wall.x) / wall.norm().max(f64::MIN_POSITIVE);
    let estimate = LineEstimate { line: HessianLine::new(0.0, 0.0), covariance };
    let edge = |side: f64| {
        let point = move |k: u32| {
            let share = f64::from(k) / f64::from(N_PIECES);
            let sigma = estimate.variance_at(from + share * (to - from)).max(0.0).sqrt();
            let point = start + wall * share + normal * (side * SIGMAS * sigma);
            (point.x, point.y)
        };
        (0..=N_PIECES).map(point)
    };
    edge(1.0).chain(edge(-1.0).rev()).chain(edge(1.0).take(1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn band_is_narrow_at_the_reference_point_and_wide_away_from_it() {
        let (sigma_rho, sigma_alpha) = (0.05, 0.02);
        let covariance = Matrix2::new(sigma_rho * sigma_rho, 0.0, 0.0, sigma_alpha * sigma_alpha);
        let band = wall_band([Vector2::new(1.0, -4.0), Vector2::new(1.0, 4.0)], [-4.0, 4.0], covariance);
        assert_eq!(band.first(), band.last());
        let half_width = |y: f64| {
            let beside = |point: &&(f64, f64)| (point.1 - y).abs() < 1e-9;
            band.iter().filter(beside).map(|point| (point.0 - 1.0).abs()).fold(0.0, f64::max)
        };
        let expected = |along: f64| 2.0 * sigma_rho.hypot(along * sigma_alpha);
        for y in [-4.0, -2.0, 0.0, 3.0] {
            assert!((half_width(y) - expected(y)).abs() < 1e-9, "{y}: {} {}", half_width(y), expected(y));
        }
    }
}
