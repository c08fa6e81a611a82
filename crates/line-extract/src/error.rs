/// Errors of simplification, fitting and extraction.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LineExtractionError {
    /// A tolerance is negative or not finite.
    #[error("the tolerance is {value:?}, must be finite and not negative")]
    Epsilon {
        /// The value given.
        value: f64,
    },
    /// A point is not finite, or so large that areas overflow.
    #[error("point {index} is ({x}, {y}), must be finite and within ±{largest:e}")]
    Point {
        /// Which point.
        index: usize,
        /// Its coordinates.
        x: f64,
        /// Its coordinates.
        y: f64,
        /// The largest coordinate allowed.
        largest: f64,
    },
    /// A parameter is out of range.
    #[error("parameter {what} is {value:?}, must be {must}")]
    Param {
        /// Its name, with its unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// A number of the scan geometry is out of range.
    #[error("scan: {what} is {value:?}, must be {must}")]
    Scan {
        /// Which number, with its unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// The beams of one scan cover more than a full turn.
    #[error("scan: {n_beams} beams of {increment_rad} rad go beyond a full turn")]
    MoreThanATurn {
        /// Number of beams.
        n_beams: usize,
        /// From one to the next.
        increment_rad: f64,
    },
    /// The number of covariances differs from the number of points.
    #[error("{covariances} covariances for {points} points")]
    Sizes {
        /// Number of points.
        points: usize,
        /// Number of covariances.
        covariances: usize,
    },
    /// Too few points for a line.
    #[error("{got} points, a line needs {needed}")]
    TooFewPoints {
        /// Number of points given.
        got: usize,
        /// Number of points required.
        needed: usize,
    },
    /// The points have no direction: their extent is within their noise.
    #[error("{n_points} points of extent {extent_m:e} m have no direction")]
    NoDirection {
        /// Number of points.
        n_points: usize,
        /// RMS spread of the points along the line, m.
        extent_m: f64,
    },
    /// A covariance is not positive definite.
    #[error("the covariance of (ρ, α) is not positive definite: determinant {determinant:e}")]
    NotPositiveDefinite {
        /// Its determinant.
        determinant: f64,
    },
}
