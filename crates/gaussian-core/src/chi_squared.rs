use statrs::distribution::{ChiSquared, ContinuousCDF};
use statrs::function::gamma::gamma_lr;

use crate::GaussianError;

/// A gate on squared Mahalanobis distances: the quantile is computed once, each test is one comparison.
///
/// ```
/// use wayfix_gaussian_core::ChiSquaredGate;
/// let gate = ChiSquaredGate::from_probability(2, 0.95)?;
/// assert!((gate.threshold() - 5.991464547107979).abs() < 1e-9); // scipy.stats.chi2.ppf(0.95, 2)
/// assert!(gate.accepts(5.9) && !gate.accepts(6.0) && !gate.accepts(f64::NAN));
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquaredGate {
    threshold: f64,
}

impl ChiSquaredGate {
    /// The gate that accepts the share `probability` of the true measurements of dimension `dof`.
    ///
    /// # Errors
    /// Returns an error if `dof` is 0 or `probability` is not between 0 and 1 (both excluded).
    pub fn from_probability(dof: usize, probability: f64) -> Result<Self, GaussianError> {
        Ok(Self { threshold: quantile(dof, probability)? })
    }
    /// Whether a squared distance is inside. NaN is not.
    pub fn accepts(&self, squared_distance: f64) -> bool {
        squared_distance <= self.threshold
    }
    /// The largest squared distance inside.
    pub fn threshold(&self) -> f64 {
        self.threshold
    }
}

/// The interval of the average of chi-squared values over several runs of a consistent filter.
///
/// Two-sided: $`[\,χ^2_{N n}(\tfrac{1-p}{2}),\; χ^2_{N n}(\tfrac{1+p}{2})\,] / N`$ for NEES or NIS of $`n`$ degrees of freedom averaged over
/// $`N`$ **independent** runs. [Bar-Shalom et al. 2001, Sec. 5.4.2]
///
/// ```
/// use wayfix_gaussian_core::ChiSquaredBand;
/// let band = ChiSquaredBand::for_average(2, 50, 0.95)?;
/// // scipy.stats.chi2.ppf([0.025, 0.975], 100) / 50
/// assert!((band.low - 1.4844385495).abs() < 1e-8 && (band.high - 2.5912239437).abs() < 1e-8);
/// assert!(band.contains(2.0));
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquaredBand {
    /// Below it the covariance is too large: a pessimistic filter.
    pub low: f64,
    /// Above it the covariance is too small: an overconfident filter.
    pub high: f64,
}

impl ChiSquaredBand {
    /// The band that holds the average of `runs` values of `dof` degrees of freedom with `probability`.
    ///
    /// # Errors
    /// Returns an error if `dof` or `runs` is 0 or `probability` is not between 0 and 1 (both excluded).
    pub fn for_average(dof: usize, runs: usize, probability: f64) -> Result<Self, GaussianError> {
        check_probability(probability)?;
        let total = dof.saturating_mul(runs);
        let tail = 0.5 * (1.0 - probability);
        let n = runs as f64;
        Ok(Self { low: quantile(total, tail)? / n, high: quantile(total, 1.0 - tail)? / n })
    }
    /// Whether `average` is inside. NaN is not.
    pub fn contains(&self, average: f64) -> bool {
        (self.low..=self.high).contains(&average)
    }
}

/// The quantile `probability` of a chi-squared variable with `dof` degrees of freedom.
fn quantile(dof: usize, probability: f64) -> Result<f64, GaussianError> {
    check_probability(probability)?;
    let out_of_range =
        |_| GaussianError::Parameter { what: "degrees of freedom", value: dof as f64, range: "at least 1" };
    let value = ChiSquared::new(dof as f64)
        .map(|chi_squared| chi_squared.inverse_cdf(probability))
        .map_err(out_of_range)?;
    Ok(if value < LOW { lower_tail(dof as f64, probability) } else { value })
}

/// Below this the search by absolute width of `inverse_cdf` leaves too few digits.
const LOW: f64 = 1.0;

/// A small quantile to a relative width, by bisection of its logarithm.
fn lower_tail(dof: f64, probability: f64) -> f64 {
    let (mut low, mut high) = (f64::MIN_POSITIVE.ln(), (2.0 * LOW).ln());
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if gamma_lr(0.5 * dof, 0.5 * middle.exp()) < probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    (0.5 * (low + high)).exp()
}

fn check_probability(value: f64) -> Result<(), GaussianError> {
    if value > 0.0 && value < 1.0 {
        return Ok(());
    }
    Err(GaussianError::Parameter { what: "probability", value, range: "between 0 and 1, both excluded" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    #[test]
    fn lower_tail_with_two_degrees_is_the_exponential() {
        for probability in [1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.05, 0.3] {
            let expected = -2.0 * f64::ln_1p(-probability);
            let found = quantile(2, probability).unwrap();
            assert!(abs_diff_eq!(found / expected, 1.0, epsilon = 1e-9), "{probability}: {found} {expected}");
        }
    }

    #[test]
    fn lower_tail_with_one_and_three_degrees_is_that_of_scipy() {
        // scipy.stats.chi2.ppf
        for (dof, probability, expected) in [
            (1, 1e-6, 1.570796326797103e-12),
            (1, 1e-3, 1.5707971492624921e-6),
            (3, 1e-6, 2.4181037862424593e-4),
            (3, 1e-3, 2.4297585815692657e-2),
        ] {
            let found = quantile(dof, probability).unwrap();
            assert!(
                abs_diff_eq!(found / expected, 1.0, epsilon = 1e-6),
                "{dof} {probability}: {found} {expected}"
            );
        }
    }
}
