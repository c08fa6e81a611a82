use crate::error::{IntegrityError, check, check_ratio};

/// Page's cumulative sum: detects that measurements begin to follow another distribution. [Page 1954]
///
/// ```math
/// g ← \max\left(0,\; g + \log \frac{p_1(z)}{p_0(z)}\right),\qquad \text{alarm when } g > h
/// ```
///
/// The mean number of measurements to a false alarm is at least $`e^h`$. [Lorden 1971, Theorem 2]
///
/// ```
/// use wayfix_integrity::CusumTest;
/// let mut sum = CusumTest::from_false_alarm_rate(1e-3)?; // at most one false alarm in 1000 measurements
/// assert!(!sum.observe(-3.0)? && !sum.observe(5.0)?);
/// assert!(sum.observe(5.0)?); // 10 nats exceed ln 1000
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CusumTest {
    threshold: f64,
    sum: f64,
}

impl CusumTest {
    /// A sum with the threshold $`h = -\ln`$ `rate`, where `rate` is the largest mean number of false alarms per measurement.
    ///
    /// # Errors
    /// Returns an error if `rate` is not between 0 and 1, both excluded.
    pub fn from_false_alarm_rate(rate: f64) -> Result<Self, IntegrityError> {
        check("false alarm rate", rate, rate > 0.0 && rate < 1.0, "between 0 and 1, both excluded")?;
        Ok(Self { threshold: -rate.ln(), sum: 0.0 })
    }

    /// Adds the log-likelihood ratio of a measurement, in nats. Returns whether the sum exceeds the threshold. An alarm clears the sum.
    ///
    /// # Errors
    /// Returns an error if the ratio is NaN.
    pub fn observe(&mut self, log_likelihood_ratio: f64) -> Result<bool, IntegrityError> {
        check_ratio(log_likelihood_ratio)?;
        self.sum = (self.sum + log_likelihood_ratio).max(0.0);
        let alarm = self.sum > self.threshold;
        if alarm {
            self.sum = 0.0;
        }
        Ok(alarm)
    }

    /// The sum $`g`$, in nats.
    pub fn sum(&self) -> f64 {
        self.sum
    }
}
