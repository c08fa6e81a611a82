use nalgebra::{Matrix2, SymmetricEigen, Vector2};

/// A point of a scan on something that is straight around it, with the unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfacePoint {
    pub(crate) at: Vector2<f64>,
    pub(crate) normal: Vector2<f64>,
    /// Variance of the direction of the normal, rad².
    pub(crate) normal_variance: f64,
}

/// Number of neighbours on each side used for the normal.
const N_NEIGHBOURS: usize = 3;
/// So many of them must be near.
const FEWEST: usize = 4;
/// Neighbours are near within this distance, m, or this share of the range: a flat view spreads the points.
const NEAR: (f64, f64) = (0.3, 0.1);
/// Limit of the variance across a straight surface: this share of the variance along it, plus a square centimetre.
const STRAIGHT: (f64, f64) = (0.05, 1e-4);

/// Surfaces from the points of a scan, in beam order.
pub(crate) fn surfaces(points: &[Option<Vector2<f64>>]) -> Vec<SurfacePoint> {
    (0..points.len()).filter_map(|beam| surface(points, beam)).collect()
}

fn surface(points: &[Option<Vector2<f64>>], beam: usize) -> Option<SurfacePoint> {
    let at = points[beam]?;
    let reach = NEAR.0.max(NEAR.1 * at.norm());
    let window = &points[beam.saturating_sub(N_NEIGHBOURS)..points.len().min(beam + N_NEIGHBOURS + 1)];
    let near: Vec<Vector2<f64>> =
        window.iter().flatten().filter(|point| (*point - at).norm() < reach).copied().collect();
    if near.len() < FEWEST {
        return None;
    }
    let n = near.len() as f64;
    let mean = near.iter().sum::<Vector2<f64>>() / n;
    let scatter: Matrix2<f64> =
        near.iter().map(|point| (point - mean) * (point - mean).transpose()).sum::<Matrix2<f64>>() / n;
    let spread = SymmetricEigen::new(scatter);
    let across = spread.eigenvalues.imin();
    let (across_variance, along_variance) = (spread.eigenvalues[across], spread.eigenvalues[1 - across]);
    let is_straight = across_variance <= STRAIGHT.0 * along_variance + STRAIGHT.1;
    is_straight.then(|| SurfacePoint {
        at,
        normal: spread.eigenvectors.column(across).into_owned(),
        normal_variance: across_variance.max(0.0) / ((n - 2.0) * along_variance), // the slope of a line fit
    })
}
