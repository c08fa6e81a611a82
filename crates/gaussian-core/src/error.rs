/// Why an operation on Gaussians failed. The operands are unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GaussianError {
    /// A covariance is not positive definite.
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
    /// A dimension does not match.
    #[error("{what} has dimension {got}, expected {expected}")]
    Dimension {
        /// What has the wrong size.
        what: &'static str,
        /// The expected size.
        expected: usize,
        /// The size given.
        got: usize,
    },
    /// An index set contains a coordinate that does not exist, or a repeated one.
    #[error("index {index} is out of range or repeated (dimension {dimension})")]
    Index {
        /// The index.
        index: usize,
        /// The dimension of the state.
        dimension: usize,
    },
    /// A list that must hold something is empty.
    #[error("no {what}")]
    Empty {
        /// The missing elements.
        what: &'static str,
    },
    /// A list is too short for the estimation.
    #[error("{got} {what}, need at least {needed}")]
    TooFew {
        /// The elements of the list.
        what: &'static str,
        /// How many are enough.
        needed: usize,
        /// How many there are.
        got: usize,
    },
    /// A coordinate is never observed.
    #[error("coordinate {coordinate} is never observed")]
    Unobserved {
        /// Which one.
        coordinate: usize,
    },
    /// An angle is so uncertain that its sigma points meet on the other side of the circle.
    #[error(
        "a sigma point {length:.2} out goes more than half round a circle: the unscented transform needs a smaller covariance or alpha"
    )]
    SigmaPointWraps {
        /// Length of the tangent vector from the mean to the point.
        length: f64,
    },
    /// A parameter is outside its range.
    #[error("{what} is {value}, must be {range}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The values it may take.
        range: &'static str,
    },
    /// A weight is negative or NaN.
    #[error("weight {index} is {value}")]
    Weight {
        /// Whose weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The weights are all zero and cannot be normalized.
    #[error("all {count} weights are zero")]
    NoWeight {
        /// How many there are.
        count: usize,
    },
    /// An iteration did not converge; [`IterationError`] holds its last estimate.
    #[error("{what} did not converge in {iterations} iterations (last step {step:e})")]
    NotConverged {
        /// Which iteration.
        what: &'static str,
        /// How many steps it took.
        iterations: usize,
        /// Length of the last step.
        step: f64,
    },
}

/// Why an iteration on a manifold failed, with its last estimate if there is one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IterationError<X> {
    /// A step could not be taken.
    #[error(transparent)]
    Step(#[from] GaussianError),
    /// The points are spread too far for a mean, or the budget was too small.
    #[error("{what} did not converge in {iterations} iterations (last step {step:e})")]
    NotConverged {
        /// Which iteration.
        what: &'static str,
        /// The last estimate.
        last: X,
        /// How many steps it took.
        iterations: usize,
        /// Length of the last step.
        step: f64,
    },
}

/// Drops the last estimate.
impl<X> From<IterationError<X>> for GaussianError {
    fn from(error: IterationError<X>) -> Self {
        match error {
            IterationError::Step(error) => error,
            IterationError::NotConverged { what, iterations, step, .. } => {
                Self::NotConverged { what, iterations, step }
            }
        }
    }
}
