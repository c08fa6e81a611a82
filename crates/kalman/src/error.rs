use wayfix_gaussian_core::{GaussianError, IterationError};

/// Why a filter refused a call. The filter is then unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum KalmanError {
    /// A vector or matrix is invalid: wrong size, not finite, not symmetric or not positive definite.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// The iterated update did not converge.
    #[error("no convergence after {iterations} iterations, last step {last_step:e} standard deviations")]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// Largest component of the last step, in prior standard deviations.
        last_step: f64,
        /// The last estimate, as tangent vector from the predicted mean: `mean.retract(&last_offset)` is the point.
        last_offset: Box<[f64]>,
    },
    /// A parameter is out of range.
    #[error("{what} is {value:e}, out of range")]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A row of a Markov transition matrix is not a probability distribution.
    #[error("row {row} of the transition matrix sums to {sum}, or has an entry that is not a probability")]
    NotStochastic {
        /// Which row.
        row: usize,
        /// Its sum.
        sum: f64,
    },
    /// A bank or chain has no models.
    #[error("a bank needs at least one model")]
    EmptyBank,
    /// Under every model of a bank the measurement has zero likelihood.
    #[error("no model of the bank explains the measurement")]
    AllModelsImpossible,
}

/// Forgets the last estimate of a mean on a manifold.
impl<X> From<IterationError<X>> for KalmanError {
    fn from(error: IterationError<X>) -> Self {
        Self::Gaussian(error.into())
    }
}

/// What the crate's checks say, in short.
pub(crate) type Checked<T = ()> = Result<T, KalmanError>;
