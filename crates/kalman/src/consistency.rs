use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, StateAlloc};
use wayfix_gaussian_core::{ChiSquaredBand, Gaussian};

use crate::KalmanError;

/// The normalized estimation error squared, $`(x ⊟ \hat x)^T P^{-1} (x ⊟ \hat x)`$, of an estimate with known truth.
///
/// Chi-squared with the dimension of the state as degrees of freedom if the filter is consistent. [Bar-Shalom et al. 2001, Eq. 5.4.2-1]
/// The normalized innovation squared needs no truth: [`Innovation::nis`](crate::Innovation::nis).
///
/// # Errors
/// Returns an error if the truth is not finite or of another dimension, or the covariance is not positive definite.
pub fn nees<X: Manifold>(estimate: &Gaussian<X>, truth: &X) -> Result<f64, KalmanError>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    Ok(estimate.mahalanobis_squared(truth)?)
}

/// Averages NEES or NIS values and compares with the chi-squared band.
///
/// The band holds for **independent** values: NIS over time of one run, or NEES of one instant over many runs.
///
/// ```
/// use wayfix_kalman::ConsistencyStatistics;
/// let mut nis = ConsistencyStatistics::new(2);
/// for value in [1.2, 3.0, 0.4, 2.6, 1.8] {
///     nis.push(value);
/// }
/// assert!((nis.average() - 1.8).abs() < 1e-15);
/// assert!(nis.band(0.95)?.contains(nis.average()));
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConsistencyStatistics {
    dof: usize,
    sum: f64,
    count: usize,
}

impl ConsistencyStatistics {
    /// For values of `dof` degrees of freedom each.
    pub fn new(dof: usize) -> Self {
        Self { dof, sum: 0.0, count: 0 }
    }
    /// Adds a value.
    pub fn push(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }
    /// Values so far.
    pub fn count(&self) -> usize {
        self.count
    }
    /// Their average; NaN when there are none.
    pub fn average(&self) -> f64 {
        self.sum / self.count as f64
    }
    /// The interval of the average of a consistent filter with `probability`.
    ///
    /// # Errors
    /// Returns an error if there are no values, `dof` is 0, or `probability` is not between 0 and 1.
    pub fn band(&self, probability: f64) -> Result<ChiSquaredBand, KalmanError> {
        Ok(ChiSquaredBand::for_average(self.dof, self.count, probability)?)
    }
}
