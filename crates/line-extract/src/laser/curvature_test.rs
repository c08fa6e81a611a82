//! Whether pieces are chords of an arc.

use nalgebra::Vector2;

use super::RangeBearingNoise;
use crate::LineEstimate;

/// A parabola across a line, fitted to the residuals of the line: coefficient times information, and information.
///
/// The parabola is orthogonal to the line's position and direction. The normal points away from the sensor, so that chords of one arc have
/// curvature of one sign.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CurvatureTest {
    fitted: f64,
    information: f64,
}

impl CurvatureTest {
    /// A straight wall bulges by `bulge_sigma` between the middle and the ends of a piece, which as a coefficient is $`4 σ / l^2`$.
    pub(super) fn of(
        points: &[Vector2<f64>],
        on: &LineEstimate,
        noise: &RangeBearingNoise,
        bulge_sigma: f64,
    ) -> Self {
        let (normal, direction) = (on.line.normal(), on.line.direction());
        let weight = |p: &Vector2<f64>| noise.weight(p, &normal);
        let mean = |of: &dyn Fn(&Vector2<f64>) -> f64| {
            let sums = points.iter().map(|p| (weight(p), of(p)));
            let (total, sum) = sums.fold((0.0, 0.0), |(total, sum), (w, x)| (total + w, sum + w * x));
            sum / total
        };
        let middle = mean(&|p| direction.dot(p));
        let along = |p: &Vector2<f64>| direction.dot(p) - middle;
        let spread = mean(&|p| along(p).powi(2));
        let skew = mean(&|p| along(p).powi(3)) / spread;
        let length = points.first().zip(points.last()).map_or(0.0, |(a, b)| direction.dot(&(b - a)).abs());
        let bulge = 4.0 * bulge_sigma / (length * length);
        let by_noise = points.iter().fold(Self::default(), |bend, p| {
            let (w, parabola) = (weight(p), along(p) * (along(p) - skew) - spread);
            Self {
                fitted: bend.fitted + w * parabola * on.line.signed_distance(p),
                information: bend.information + w * parabola * parabola,
            }
        });
        let share = 1.0 / (1.0 + by_noise.information * bulge * bulge);
        Self { fitted: by_noise.fitted * share, information: by_noise.information * share }
    }

    fn with(self, other: Self) -> Self {
        Self { fitted: self.fitted + other.fitted, information: self.information + other.information }
    }

    /// The squared coefficient over its variance; chi-squared with one degree of freedom on a straight wall.
    fn is_significant(self) -> bool {
        self.fitted * self.fitted > CURVED * self.information
    }

    /// Whether the common curvature is within 99.9 % of this piece's own.
    fn agrees(self, common: Self) -> bool {
        let off = self.fitted * common.information - common.fitted * self.information;
        off * off <= CURVED * self.information * common.information * common.information
    }
}

/// Which of the pieces of one surface are chords of arcs: runs of neighbours that agree on a curvature that is significant.
pub(super) fn curved(bends: &[CurvatureTest]) -> Vec<bool> {
    let mut curved = vec![false; bends.len()];
    for first in 0..bends.len() {
        let mut common = CurvatureTest::default();
        for last in first..bends.len() {
            common = common.with(bends[last]);
            let run = first..=last;
            if common.is_significant() && bends[run.clone()].iter().all(|bend| bend.agrees(common)) {
                curved[run].fill(true);
            }
        }
    }
    curved
}

/// 99.9 % of chi-squared with one degree of freedom, the share at which two pieces are one wall.
const CURVED: f64 = 10.827_566_170_662_733;
