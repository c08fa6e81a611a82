use crate::error::{IntegrityError, check, check_ratio};

/// Which of two hypotheses the measurements so far support.
///
/// ```
/// use wayfix_integrity::{ProbabilityRatioTest, RatioVerdict};
/// let mut test = ProbabilityRatioTest::from_error_rate(1e-3)?; // ln 1000 is 6.9 nats
/// assert_eq!(test.observe(8.0)?, RatioVerdict::Second);
/// assert_eq!(test.observe(-4.0)?, RatioVerdict::Undecided); // revoked: 4 nats are left
/// assert_eq!(test.observe(-11.0)?, RatioVerdict::First);
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RatioVerdict {
    /// Neither at the error rate.
    Undecided,
    /// The first one.
    First,
    /// The second one.
    Second,
}

/// Wald's sequential probability ratio test: which of two hypotheses explains the measurements? [Wald 1945]
///
/// ```math
/// Λ ← Λ + \log \frac{p_2(z)}{p_1(z)},\qquad \text{second when } Λ ≥ -\ln α,\quad \text{first when } Λ ≤ \ln α
/// ```
///
/// The probability that the wrong one is ever chosen is at most $`α`$, for any number of measurements [Ville 1939]. The sum continues after a verdict; later
/// measurements can revoke it.
///
/// ```
/// use wayfix_integrity::{ProbabilityRatioTest, RatioVerdict};
/// let mut test = ProbabilityRatioTest::from_error_rate(1e-3)?;
/// assert_eq!(test.observe(4.0)?, RatioVerdict::Undecided);
/// assert_eq!(test.observe(4.0)?, RatioVerdict::Second); // 8 nats exceed ln 1000
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbabilityRatioTest {
    threshold: f64,
    sum: f64,
}

impl ProbabilityRatioTest {
    /// A test that chooses the wrong hypothesis with a probability of at most `rate`.
    ///
    /// # Errors
    /// Returns an error if `rate` is not between 0 and 1, both excluded.
    pub fn from_error_rate(rate: f64) -> Result<Self, IntegrityError> {
        check("error rate", rate, rate > 0.0 && rate < 1.0, "between 0 and 1, both excluded")?;
        Ok(Self { threshold: -rate.ln(), sum: 0.0 })
    }

    /// The same with the sum of an earlier test.
    ///
    /// # Errors
    /// Returns an error if the sum is NaN.
    pub fn with_sum(self, sum: f64) -> Result<Self, IntegrityError> {
        check_ratio(sum)?;
        Ok(Self { sum, ..self })
    }

    /// Adds the log-likelihood ratio of a measurement, in nats: positive if it supports the second hypothesis.
    ///
    /// # Errors
    /// Returns an error if the sum becomes NaN.
    pub fn observe(&mut self, log_likelihood_ratio: f64) -> Result<RatioVerdict, IntegrityError> {
        let sum = self.sum + log_likelihood_ratio;
        check_ratio(sum)?;
        self.sum = sum;
        Ok(self.verdict())
    }

    /// The verdict so far.
    pub fn verdict(&self) -> RatioVerdict {
        if self.sum >= self.threshold {
            RatioVerdict::Second
        } else if self.sum <= -self.threshold {
            RatioVerdict::First
        } else {
            RatioVerdict::Undecided
        }
    }

    /// The sum $`Λ`$, in nats.
    pub fn sum(&self) -> f64 {
        self.sum
    }
}
