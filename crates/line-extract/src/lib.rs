//! Lines from points: chains with fewer corners, and walls from the range scans of a laser.
//!
//! | from | to | with |
//! | --- | --- | --- |
//! | a chain of points | the indices of those that matter | [`simplify()`], [`douglas_peucker`] |
//! | points with covariances | a line with its covariance | [`fit_line`] |
//! | a range scan | walls with covariances and ends | [`extract`], [`LineExtractor`] |
//! | a predicted wall | its search band and its segment | [`WallHypothesis`] |
//!
//! Metres and radians, x forward, y left. Scans, segments and hypotheses are in the sensor's frame; the crate has no filters and no poses. The methods, their
//! parameters and measured figures are in `docs/lines.md`.
//!
//! ```
//! use wayfix_line_extract::{LineExtractionParams, Scan, extract};
//!
//! // A wall at y = 1 m, seen by 61 beams, two of which came back with nothing.
//! let bearing = |i: usize| 60_f64.to_radians() + i as f64 * 1_f64.to_radians();
//! let mut ranges: Vec<_> = (0..61).map(|i| 1.0 / bearing(i).sin()).collect();
//! ranges[20] = f64::NAN;
//! ranges[40] = f64::INFINITY;
//! let scan =
//!     Scan { angle_min: bearing(0), angle_increment: 1_f64.to_radians(), ranges: &ranges, max_range: 8.0 };
//! let seen = extract(&scan, &LineExtractionParams::default())?;
//! assert_eq!((seen.segments.len(), seen.counts.skipped()), (1, 2));
//! let wall = &seen.segments[0];
//! assert!((wall.estimate.line.rho() - 1.0).abs() < 1e-6);
//! assert!((wall.estimate.line.alpha() - 90_f64.to_radians()).abs() < 1e-6);
//! assert!(wall.estimate.covariance[(0, 0)].sqrt() < 0.01 / 7.0); // 59 echoes of 1 cm
//! # Ok::<(), wayfix_line_extract::LineExtractionError>(())
//! ```

mod check;
mod error;
mod laser;
mod line;
mod simplify;

pub use error::LineExtractionError;
pub use laser::{
    BeamCounts, LineExtraction, LineExtractionParams, LineExtractor, RangeBearingNoise, Scan, SplitMethod,
    WallHypothesis, WallSegment, extract,
};
pub use line::{HessianLine, LineEstimate, LineFit, fit_line};
pub use simplify::{PointDistanceReference, PolylineSimplifier, douglas_peucker, simplify};

pub use nalgebra;
