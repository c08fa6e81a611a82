use nalgebra::Vector2;

use crate::LineEstimate;

/// The result of one scan.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineExtraction {
    /// The walls in the order of their first beams.
    pub segments: Vec<WallSegment>,
    /// Beam counts by use.
    pub counts: BeamCounts,
}

/// A piece of a wall, in the sensor's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WallSegment {
    /// The line it is on, with its covariance.
    pub estimate: LineEstimate,
    /// Its observed start, m; from here to `end` the sensor is on the left.
    pub start: Vector2<f64>,
    /// Its observed end, metres.
    pub end: Vector2<f64>,
    /// Number of echoes in the fit.
    pub n_points: usize,
    /// Weighted root mean square distance of these echoes from the line, metres.
    pub rms_m: f64,
    /// The sum of their squared distances over their variances; chi-squared with `n_points - 2` degrees of freedom.
    pub chi_squared: f64,
    /// The first and the last beam that hit it.
    pub beams: (usize, usize),
}

impl WallSegment {
    /// From end to end, metres.
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }
}

/// Beam counts by use. The first five sum to the number of beams.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BeamCounts {
    /// Ranges in (0, max].
    pub valid: usize,
    /// NaN.
    pub nan: usize,
    /// Infinite, of either sign.
    pub infinite: usize,
    /// Zero or negative.
    pub not_positive: usize,
    /// Finite and beyond the largest range.
    pub beyond_max: usize,
    /// Surfaces between jumps of the range, single echoes included.
    pub surfaces: usize,
    /// Echoes that a segment was fitted to.
    pub in_segments: usize,
}

impl BeamCounts {
    /// Beams without a usable echo.
    pub fn skipped(&self) -> usize {
        self.nan + self.infinite + self.not_positive + self.beyond_max
    }
}
