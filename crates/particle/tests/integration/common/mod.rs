//! Averages over independent runs, and how far off they may be.

use approx::abs_diff_eq;

/// Results of independent runs.
pub(crate) struct Runs<'a>(pub(crate) &'a [f64]);

impl Runs<'_> {
    /// Panics when the average is further from `exact` than five standard errors (once in a million, for 200 runs) and a known bias.
    pub(crate) fn agree_with(&self, exact: f64, bias: f64) {
        let (mean, error) = (mean(self.0), standard_error(self.0));
        assert!(abs_diff_eq!(mean, exact, epsilon = 5.0 * error + bias), "{mean} ± {error}, exact {exact}");
    }
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Of the mean, as the values' own spread shows it.
pub(crate) fn standard_error(values: &[f64]) -> f64 {
    let (mean, n) = (mean(values), values.len() as f64);
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt()
}
