use nalgebra::{Matrix2, Vector2};

use super::{HessianLine, LineEstimate};
use crate::LineExtractionError;

/// The moments of points for a weighted fit: number, weight, mean and spread.
///
/// Weights are inverse variances across the line, 1/m².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moments {
    pub(crate) n_points: usize,
    weight: f64,
    mean: Vector2<f64>,
    /// $`\sum w (p - \bar p)(p - \bar p)^T`$: xx, xy, yy.
    spread: [f64; 3],
}

impl Moments {
    /// Sums about the first point, to keep precision far from the origin.
    pub(crate) fn new(points: &[Vector2<f64>], weight: impl Fn(usize) -> f64) -> Self {
        let (mut total, mut sum) = (0.0, Vector2::zeros());
        let origin = points.first().copied().unwrap_or_default();
        let mut about = [0.0; 3];
        for (k, p) in points.iter().enumerate() {
            let (w, d) = (weight(k), p - origin);
            total += w;
            sum += d * w;
            about[0] += w * d.x * d.x;
            about[1] += w * d.x * d.y;
            about[2] += w * d.y * d.y;
        }
        let mean = if total > 0.0 { sum / total } else { sum };
        let spread = [
            about[0] - total * mean.x * mean.x,
            about[1] - total * mean.x * mean.y,
            about[2] - total * mean.y * mean.y,
        ];
        Self { n_points: points.len(), weight: total, mean: origin + mean, spread }
    }

    /// Those of both sets of points together [Chan, Golub & LeVeque 1979].
    pub(crate) fn with(&self, other: &Self) -> Self {
        let weight = self.weight + other.weight;
        let apart = other.mean - self.mean;
        let share = self.weight * other.weight / weight;
        let cross = [apart.x * apart.x, apart.x * apart.y, apart.y * apart.y];
        Self {
            n_points: self.n_points + other.n_points,
            weight,
            mean: self.mean + apart * (other.weight / weight),
            spread: std::array::from_fn(|i| self.spread[i] + other.spread[i] + share * cross[i]),
        }
    }

    /// The line of least weighted squares across it [Arras & Siegwart 1997], and the covariance from the weights.
    ///
    /// At the mean point, place and direction are uncorrelated with variances $`1/\sum w`$ and $`1/\sum w s^2`$, $`s`$ along the line; the
    /// covariance is carried from there to the foot of the origin's perpendicular.
    pub(crate) fn line(&self) -> Result<LineEstimate, LineExtractionError> {
        let [xx, xy, yy] = self.spread;
        let alpha = 0.5 * (-2.0 * xy).atan2(yy - xx);
        let (normal, direction) =
            (Vector2::new(alpha.cos(), alpha.sin()), Vector2::new(-alpha.sin(), alpha.cos()));
        let along = xx * direction.x * direction.x
            + 2.0 * xy * direction.x * direction.y
            + yy * direction.y * direction.y;
        let extent_m = (along / self.weight).sqrt();
        // Below the resolution of the coordinates the direction is rounding noise.
        if !(extent_m > 1e-12 * self.mean.amax() && along.is_finite()) {
            return Err(LineExtractionError::NoDirection { n_points: self.n_points, extent_m });
        }
        let rho = normal.dot(&self.mean);
        let arm = direction.dot(&self.mean);
        // The opposite normal flips the sign of ρ, and so of its covariance with α.
        let sign = if rho < 0.0 { -1.0 } else { 1.0 };
        let both = sign * arm / along;
        let covariance = Matrix2::new(1.0 / self.weight + arm * arm / along, both, both, 1.0 / along);
        Ok(LineEstimate { line: HessianLine::new(rho, alpha), covariance })
    }

    /// $`\sum w e^2`$ over distances $`e`$ to a line through the mean point.
    pub(crate) fn chi_squared(&self, line: &HessianLine) -> f64 {
        let n = line.normal();
        let [xx, xy, yy] = self.spread;
        (xx * n.x * n.x + 2.0 * xy * n.x * n.y + yy * n.y * n.y).max(0.0)
    }

    /// Root of the weighted mean square distance to a line through the mean point, metres.
    pub(crate) fn rms(&self, line: &HessianLine) -> f64 {
        (self.chi_squared(line) / self.weight).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn two_parts_make_the_whole() {
        let points: Vec<_> = (0..20).map(|k| Vector2::new(f64::from(k), f64::from(k * k % 7))).collect();
        let weight = |k: usize| 1.0 + k as f64;
        let whole = Moments::new(&points, weight);
        let parts = Moments::new(&points[..8], weight).with(&Moments::new(&points[8..], |k| weight(k + 8)));
        assert_eq!(whole.n_points, parts.n_points);
        assert_abs_diff_eq!(whole.mean, parts.mean, epsilon = 1e-12);
        for (a, b) in whole.spread.iter().zip(parts.spread) {
            assert_abs_diff_eq!(*a, b, epsilon = 1e-9 * a.abs());
        }
    }
}
