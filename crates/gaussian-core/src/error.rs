/// Why an operation on Gaussians failed. The operands are as they were.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GaussianError {
    /// A covariance is not symmetric positive definite.
    #[error("{what} covariance is not positive definite (pivot {pivot} is {value:e})")]
    NotPositiveDefinite {
        /// Which covariance.
        what: &'static str,
        /// The first pivot that fails.
        pivot: usize,
        /// Its value.
        value: f64,
    },
    /// A covariance is not symmetric.
    #[error("{what} covariance is not symmetric (entries differ by {difference:e})")]
    NotSymmetric {
        /// Which covariance.
        what: &'static str,
        /// The largest difference across the diagonal.
        difference: f64,
    },
    /// Something is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// What it is.
        what: &'static str,
    },
    /// Sizes do not fit.
    #[error("{what} has dimension {got}, expected {expected}")]
    Dimension {
        /// What has the wrong size.
        what: &'static str,
        /// The size that fits.
        expected: usize,
        /// The size that came.
        got: usize,
    },
}
