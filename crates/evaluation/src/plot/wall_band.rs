/// Standard deviations from the wall to the edge of its band.
const SIGMAS: f64 = 2.0;
/// Pieces of an edge, which is a hyperbola.
const N_PIECES: u32 = 8;

/// Outline of the 2σ band of a wall between two points, for [`MapPlot::bands`](super::MapPlot::bands).
///
/// `stretch` has their places along the wall in m, from the point that the covariance of $`(ρ, α)`$ is about. At a place $`s`$ the variance is
/// $`σ_ρ^2 - 2 s σ_{ρα} + s^2 σ_α^2`$.
/// ```
/// use wayfix_evaluation::plot::wall_band;
/// // 5 cm and 0.02 rad about the middle of a wall of 8 m.
/// let band = wall_band([(1.0, -4.0), (1.0, 4.0)], [-4.0, 4.0], [[0.05 * 0.05, 0.0], [0.0, 0.02 * 0.02]]);
/// let half_width = |y: f64| {
///     band.iter().filter(|at| (at.1 - y).abs() < 1e-9).map(|at| (at.0 - 1.0).abs()).fold(0.0, f64::max)
/// };
/// assert!((half_width(0.0) - 0.1).abs() < 1e-9);
/// assert!((half_width(4.0) - 2.0 * 0.05_f64.hypot(4.0 * 0.02)).abs() < 1e-9);
/// assert_eq!(band.first(), band.last());
/// ```
pub fn wall_band(
    [start, end]: [(f64, f64); 2],
    [from, to]: [f64; 2],
    covariance: [[f64; 2]; 2],
) -> Vec<(f64, f64)> {
    let (dx, dy) = (end.0 - start.0, end.1 - start.1);
    let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
    let [[rho, both], [_, alpha]] = covariance;
    let edge = |side: f64| {
        let point = move |k: u32| {
            let share = f64::from(k) / f64::from(N_PIECES);
            let along = from + share * (to - from);
            let variance = rho - 2.0 * along * both + along * along * alpha;
            let beside = side * SIGMAS * variance.max(0.0).sqrt() / length;
            (start.0 + share * dx - beside * dy, start.1 + share * dy + beside * dx)
        };
        (0..=N_PIECES).map(point)
    };
    edge(1.0).chain(edge(-1.0).rev()).chain(edge(1.0).take(1)).collect()
}
