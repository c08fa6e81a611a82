use nalgebra::Vector2;

use super::baseline::Baseline;
use super::chain::Chain;
use super::scan::Scanner;
use super::split::{first_max, split_all, split_loop};
use crate::LineExtractionError;

/// Reference of a point's distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointDistanceReference {
    /// The line through both ends of the piece, as in [Andrade-Cetto 2005, Table 2].
    #[default]
    Line,
    /// The segment between both ends: beyond an end, the distance is that to the end.
    Segment,
}

/// The indices of the points that Douglas and Peucker's algorithm keeps, by looking at every point of every piece.
///
/// A piece from $`v_i`$ to $`v_j`$ is split at its farthest point $`v_f`$ as long as $`d_f > ε`$, with
/// $`d_k = |(v_j - v_i) \times (v_k - v_i)| / ‖v_j - v_i‖`$ [Andrade-Cetto 2005, Tables 1 and 2; the square in the printed denominator would mix
/// distance and its square]. Among equally far points the first is taken, and for [`PointDistanceReference::Line`] "equally" is decided exactly. The
/// distance to a line through coincident points is the distance to that point.
///
/// Time grows with the square of the number of points at worst: [`simplify`](crate::simplify) gives the same indices and does not have that
/// case. `points` and `epsilon` have one unit, here metres. Never recursive.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_line_extract::{PointDistanceReference, douglas_peucker};
///
/// let corner = [(0.0, 0.0), (1.0, 0.01), (2.0, 0.0), (2.01, 1.0), (2.0, 2.0)].map(|(x, y)| Vector2::new(x, y));
/// assert_eq!(douglas_peucker(&corner, 0.05, PointDistanceReference::Line)?, [0, 2, 4]);
///
/// // A spike beyond the end is on the line, but not on the segment.
/// let spike = [(0.0, 0.0), (5.0, 0.0), (2.0, 0.0)].map(|(x, y)| Vector2::new(x, y));
/// assert_eq!(douglas_peucker(&spike, 0.05, PointDistanceReference::Line)?, [0, 2]);
/// assert_eq!(douglas_peucker(&spike, 0.05, PointDistanceReference::Segment)?, [0, 1, 2]);
/// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
/// ```
///
/// # Errors
/// Returns [`LineExtractionError::Epsilon`] for a tolerance that is negative or not finite, [`LineExtractionError::Point`] for a point that is not finite or beyond
/// 1e150.
pub fn douglas_peucker(
    points: &[Vector2<f64>],
    epsilon: f64,
    distance: PointDistanceReference,
) -> Result<Vec<usize>, LineExtractionError> {
    let chain = Chain::new(points, epsilon)?;
    let (mut kept, mut scanner) = (Vec::new(), Scanner::default());
    split_all(points.len(), &mut Vec::new(), &mut kept, |start, end| match distance {
        _ if points[start] == points[end] => split_loop(&chain, start, end),
        PointDistanceReference::Line => split_line(&chain, start, end, &mut scanner),
        PointDistanceReference::Segment => split_segment(&chain, start, end),
    });
    Ok(kept)
}

fn split_line(chain: &Chain, start: usize, end: usize, scanner: &mut Scanner) -> Option<usize> {
    let line = Baseline::new(&chain.points[start], &chain.points[end], &chain.extent);
    let split = scanner.farthest(chain.points, start + 1..end, &line, chain.epsilon)?;
    (line.distance(&chain.points[split]) > chain.epsilon).then_some(split)
}

fn split_segment(chain: &Chain, start: usize, end: usize) -> Option<usize> {
    let (a, b) = (&chain.points[start], &chain.points[end]);
    let distance = |k: usize| segment_distance(&chain.points[k], a, b);
    let split = first_max(start + 1..end, distance)?;
    (distance(split) > chain.epsilon).then_some(split)
}

fn segment_distance(p: &Vector2<f64>, a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    let d = b - a;
    let along = (p - a).dot(&d) / d.norm_squared();
    // A length that underflows to zero leaves NaN, which `clamp` hands on and `max` takes for the end `a`.
    (p - (a + d * along.clamp(0.0, 1.0).max(0.0))).norm()
}
