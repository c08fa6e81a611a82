use statrs::distribution::{Beta, ContinuousCDF, StudentsT};

/// A mean with its 95 % confidence interval.
/// ```
/// use wayfix_evaluation::errors::MeanInterval;
/// let rates = MeanInterval::of(&[0.9, 1.0, 0.8, 0.9]).expect("two or more samples");
/// assert!((rates.mean - 0.9).abs() < 1e-12);
/// assert!((rates.half_width - 0.1299).abs() < 1e-4); // t(0.975, 3) = 3.182 times 0.0816 / √4
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanInterval {
    /// The mean of the samples.
    pub mean: f64,
    /// Student's interval reaches this far to both sides.
    pub half_width: f64,
    /// Number of samples.
    pub n: usize,
}

impl MeanInterval {
    /// The interval from independent samples; `None` for fewer than two.
    pub fn of(samples: &[f64]) -> Option<Self> {
        let n = samples.len();
        let mean = samples.iter().sum::<f64>() / n as f64;
        let quantile = StudentsT::new(0.0, 1.0, (n.checked_sub(1)?) as f64).ok()?.inverse_cdf(0.975);
        let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1) as f64;
        Some(Self { mean, half_width: quantile * (variance / n as f64).sqrt(), n })
    }

    /// The ratio $`r = \bar a / \bar b`$ of two means over the same samples, by linearization: the interval of the mean of $`a_i - r b_i`$ over
    /// $`|\bar b|`$. [Cochran 1977, Sampling Techniques, 6.4] `None` for fewer than two pairs, or if the numbers of samples differ.
    /// ```
    /// use wayfix_evaluation::errors::MeanInterval;
    /// let ratio = MeanInterval::of_ratio(&[1.0, 2.0, 3.0], &[2.0, 4.0, 6.0]).expect("three pairs");
    /// assert_eq!((ratio.mean, ratio.half_width), (0.5, 0.0)); // the same in every pair, however they differ from one another
    /// ```
    pub fn of_ratio(numerators: &[f64], denominators: &[f64]) -> Option<Self> {
        if numerators.len() != denominators.len() {
            return None;
        }
        let mean = |samples: &[f64]| Self::of(samples).map(|interval| interval.mean);
        let below = mean(denominators)?;
        let ratio = mean(numerators)? / below;
        let residuals: Vec<f64> = numerators.iter().zip(denominators).map(|(a, b)| a - ratio * b).collect();
        let of_residuals = Self::of(&residuals)?;
        Some(Self { mean: ratio, half_width: of_residuals.half_width / below.abs(), n: of_residuals.n })
    }
}

/// 95 % confidence interval of a probability, from `successes` of `trials`. [Clopper & Pearson 1934]
/// ```
/// let (low, high) = wayfix_evaluation::errors::proportion_interval(95, 100);
/// assert!((low - 0.8872).abs() < 1e-4 && (high - 0.9836).abs() < 1e-4); // tables of the exact binomial interval
/// ```
pub fn proportion_interval(successes: u64, trials: u64) -> (f64, f64) {
    let (k, n) = (successes.min(trials) as f64, trials as f64);
    let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).map(|beta| beta.inverse_cdf(p)).ok();
    // A shape of zero has no distribution: there the interval reaches to the end.
    let low = quantile(k, n - k + 1.0, 0.025).unwrap_or(0.0);
    let high = quantile(k + 1.0, n - k, 0.975).unwrap_or(1.0);
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn all_or_none_of_the_trials_reach_the_end_of_the_interval() {
        assert_eq!(proportion_interval(0, 10).0, 0.0);
        assert_eq!(proportion_interval(10, 10).1, 1.0);
        // (α/2)^(1/n) is the lower bound if all n trials succeed.
        assert_abs_diff_eq!(proportion_interval(10, 10).0, 0.025_f64.powf(0.1), epsilon = 1e-9);
        assert_eq!(proportion_interval(0, 0), (0.0, 1.0));
    }

    #[test]
    fn one_sample_has_no_interval() {
        assert_eq!(MeanInterval::of(&[1.0]), None);
        assert_eq!(MeanInterval::of(&[]), None);
        assert_eq!(MeanInterval::of_ratio(&[1.0, 2.0], &[1.0, 2.0, 3.0]), None);
    }
}
