/// Errors of matching two scans.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScanMatchError {
    /// A parameter or a number of the scan geometry is out of range.
    #[error("{what} is {value:?}, must be {must}")]
    Value {
        /// Which, with its unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// The requirement.
        must: &'static str,
    },
    /// Too few points of a scan lie on surfaces.
    #[error("{got} points on surfaces, a match needs {needed}")]
    TooFewPoints {
        /// Number of points given.
        got: usize,
        /// Number of points required.
        needed: usize,
    },
    /// The guess is not finite, or its covariance is not positive definite.
    #[error("the guess is not finite, or its covariance is not positive definite")]
    Guess,
}
