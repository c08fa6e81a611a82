use crate::{
    RelocalizationParams,
    error::{IntegrityError, check_distance, check_ratio},
};

/// The Shiryaev–Roberts test over distance: has the robot been kidnapped at some point of its path?
///
/// ```math
/// R ← (R + d)\, \frac{p_1(z)}{p_0(z)},\qquad \text{change when } R ≥ A
/// ```
///
/// $`d`$ is the distance since the last measurement, in m. Without a change, $`R`$ minus the distance is a martingale. The mean distance to a
/// false alarm is therefore at least $`A`$. [Pollak 1985; Tartakovsky, Nikiforov & Basseville 2015, Section 6.5]
/// With a prior $`p`$ of being moved per m, the posterior odds of a change are $`p R`$ for small $`p`$. [Shiryaev 1963]
///
/// ```
/// use wayfix_integrity::{ShiryaevRobertsTest, RelocalizationParams};
/// let mut test = ShiryaevRobertsTest::new(RelocalizationParams::default())?;
/// for _ in 0..100 {
///     test.observe(0.1, -1.0)?; // the present hypothesis explains the measurements better
/// }
/// assert!(test.probability() < 1e-3);
/// for _ in 0..10 {
///     test.observe(0.1, 2.0)?;
/// }
/// assert!(test.is_change() && test.probability() > 0.99);
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiryaevRobertsTest {
    params: RelocalizationParams,
    statistic: f64,
}

impl ShiryaevRobertsTest {
    /// A test at the statistic 0.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub fn new(params: RelocalizationParams) -> Result<Self, IntegrityError> {
        params.validate()?;
        Ok(Self { params, statistic: 0.0 })
    }

    /// Takes a measurement after `distance`, in m, with the log-likelihood ratio of "moved" against "not moved", in nats.
    ///
    /// # Errors
    /// Returns an error if the distance is negative or not finite, or the ratio is NaN.
    pub fn observe(&mut self, distance: f64, log_likelihood_ratio: f64) -> Result<(), IntegrityError> {
        check_distance(distance)?;
        check_ratio(log_likelihood_ratio)?;
        self.statistic = times(self.statistic + distance, log_likelihood_ratio);
        Ok(())
    }

    /// The statistic $`R`$, in m.
    pub fn statistic(&self) -> f64 {
        self.statistic
    }
    /// Whether the statistic reaches the threshold.
    pub fn is_change(&self) -> bool {
        self.statistic >= self.params.threshold()
    }
    /// The posterior probability of a change.
    pub fn probability(&self) -> f64 {
        self.params.probability(self.statistic)
    }
    /// Starts again at 0.
    pub fn reset(&mut self) {
        self.statistic = 0.0;
    }
}

/// `statistic` times the exponential of `log_ratio`, finite; zero stays zero.
pub(crate) fn times(statistic: f64, log_ratio: f64) -> f64 {
    if statistic == 0.0 { 0.0 } else { (statistic.ln() + log_ratio).exp().min(f64::MAX) }
}
