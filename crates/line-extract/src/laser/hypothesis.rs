use nalgebra::Vector2;

use super::WallSegment;
use crate::{LineEstimate, LineExtractionError};

/// A predicted wall: its search band, and the segments compatible with it [Andrade-Cetto 2005, Fig. 1a].
///
/// Everything is in the sensor's frame; predicting a wall of a map there, with the robot's uncertainty in the covariance, is the caller's.
///
/// ```
/// use wayfix_line_extract::nalgebra::{Matrix2, Vector2};
/// use wayfix_line_extract::{HessianLine, LineEstimate, WallHypothesis};
///
/// // A wall 3 m ahead, 4 m long, known to 10 cm and 0.02 rad.
/// let estimate =
///     LineEstimate { line: HessianLine::new(3.0, 0.0), covariance: Matrix2::new(0.01, 0.0, 0.0, 4e-4) };
/// let wall = WallHypothesis {
///     estimate,
///     start: Vector2::new(3.0, -2.0),
///     end: Vector2::new(3.0, 2.0),
///     n_sigma: 2.0,
///     margin_m: 0.5,
/// };
/// assert!(wall.in_search_band(&Vector2::new(3.19, 0.0), 0.0));
/// assert!(!wall.in_search_band(&Vector2::new(3.21, 0.0), 0.0)); // two deviations are 20 cm here,
/// assert!(wall.in_search_band(&Vector2::new(3.21, 2.4), 0.0)); // and 22 cm there
/// assert!(!wall.in_search_band(&Vector2::new(3.0, 2.6), 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WallHypothesis {
    /// The predicted line, with the covariance of the prediction.
    pub estimate: LineEstimate,
    /// Its predicted start, metres.
    pub start: Vector2<f64>,
    /// Its predicted end, metres.
    pub end: Vector2<f64>,
    /// Gate in standard deviations; the paper uses 2, which 86 % of the true segments pass.
    pub n_sigma: f64,
    /// Extension of the band beyond the ends, m.
    pub margin_m: f64,
}

impl WallHypothesis {
    /// Half the width of the search band at `along` metres from the foot of the sensor's perpendicular: `n_sigma` deviations of the line there and
    /// of a point with variance `point_variance` (m²).
    pub fn half_width(&self, along: f64, point_variance: f64) -> f64 {
        self.n_sigma * (self.estimate.variance_at(along) + point_variance).max(0.0).sqrt()
    }

    /// Whether a point is where echoes of this wall are to be expected.
    pub fn in_search_band(&self, point: &Vector2<f64>, point_variance: f64) -> bool {
        let line = &self.estimate.line;
        let along = line.direction().dot(point);
        let (from, to) = self.reach();
        let beside = from <= along && along <= to;
        beside && line.signed_distance(point).abs() <= self.half_width(along, point_variance)
    }

    /// Whether the line of a segment is within `n_sigma` of this one: $`d^2 \le n_σ^2`$, the ellipse of the paper.
    ///
    /// # Errors
    /// Returns [`LineExtractionError::NotPositiveDefinite`] if the sum of the covariances is not.
    pub fn is_compatible(&self, segment: &WallSegment) -> Result<bool, LineExtractionError> {
        let squared = self.estimate.mahalanobis_squared(&segment.estimate)?;
        Ok(squared <= self.n_sigma * self.n_sigma)
    }

    /// The most likely of the compatible segments that overlap the band; a segment may be longer than the predicted wall.
    /// # Errors
    /// Returns [`LineExtractionError::NotPositiveDefinite`] if a sum of covariances is not.
    pub fn find(&self, segments: &[WallSegment]) -> Result<Option<usize>, LineExtractionError> {
        let mut best: Option<(usize, f64)> = None;
        for (k, segment) in segments.iter().enumerate() {
            let squared = self.estimate.mahalanobis_squared(&segment.estimate)?;
            let nearest = best.is_none_or(|(_, least)| squared < least);
            if nearest && squared <= self.n_sigma * self.n_sigma && self.reaches_in(segment) {
                best = Some((k, squared));
            }
        }
        Ok(best.map(|(k, _)| k))
    }

    /// A compatible line is inside the band's width everywhere, so only the ends remain to be checked.
    fn reaches_in(&self, segment: &WallSegment) -> bool {
        let direction = self.estimate.line.direction();
        let (a, b) = (direction.dot(&segment.start), direction.dot(&segment.end));
        let (from, to) = self.reach();
        a.max(b) >= from && a.min(b) <= to
    }

    /// Extent of the band, m from the foot of the sensor's perpendicular.
    fn reach(&self) -> (f64, f64) {
        let direction = self.estimate.line.direction();
        let (a, b) = (direction.dot(&self.start), direction.dot(&self.end));
        (a.min(b) - self.margin_m, a.max(b) + self.margin_m)
    }
}
