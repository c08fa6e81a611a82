use crate::error::checked;
use crate::{CondensationError, Outcome};

/// Notices that the robot is somewhere else than believed: a cumulative sum of log evidence ratios.
///
/// ```math
/// g ← \max\left(0,\; g + \log \frac{\tfrac{1}{n} \sum_s p(m \mid s)}{\sum_s p(m \mid s)\, \hat b(s)}\right),\qquad \text{alarm when } g > h
/// ```
///
/// While the robot is where it is believed to be the ratio is below one and $`g`$ stays near zero. With a threshold of $`\log α^{-1}`$ a run
/// of measurements that fit raises an alarm with probability at most $`α`$ a start of the sum. [Page 1954; Fox et al. 1999]
///
/// ```
/// use wayfix_condensation::{MeasurementEvidence, KidnapMonitor, Outcome};
/// let mut monitor = KidnapMonitor::from_false_alarm_rate(1e-3)?;
/// let fits = Outcome::Updated(MeasurementEvidence { log_predicted: -1.0, log_uniform: -4.0 });
/// let elsewhere = Outcome::Updated(MeasurementEvidence { log_predicted: -9.0, log_uniform: -4.0 });
/// assert!(!monitor.observe(&fits) && !monitor.observe(&elsewhere));
/// assert!(monitor.observe(&elsewhere));
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KidnapMonitor {
    threshold: f64,
    sum: f64,
}

impl KidnapMonitor {
    /// A monitor whose threshold is $`-\log`$ of `rate`.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when `rate` is not between 0 and 1, both excluded.
    pub fn from_false_alarm_rate(rate: f64) -> Result<Self, CondensationError> {
        checked("false alarm rate", rate, rate > 0.0 && rate < 1.0, "between 0 and 1, both excluded")?;
        Ok(Self { threshold: -rate.ln(), sum: 0.0 })
    }

    /// Whether the measurements so far say that the robot is elsewhere. An alarm clears the sum; an impossible measurement is one.
    pub fn observe(&mut self, outcome: &Outcome) -> bool {
        let ratio = outcome.evidence().map_or(f64::INFINITY, |e| e.log_uniform - e.log_predicted);
        self.sum = (self.sum + ratio).max(0.0);
        let alarm = self.sum > self.threshold;
        if alarm {
            self.sum = 0.0;
        }
        alarm
    }

    /// The sum $`g`$, in nats.
    pub fn sum(&self) -> f64 {
        self.sum
    }
}
