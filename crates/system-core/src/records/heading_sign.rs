use std::f64::consts::TAU;

use wayfix_estimation_traits::wrap_angle;
use wayfix_integrity::{IntegrityError, ProbabilityRatioTest, RatioVerdict};

use crate::EventCounts;

/// Largest probability of a wrong verdict, and share of outliers among the headings: as rare as the correct measurements that the default gate of
/// EKF-SLAM rejects.
const ERROR_RATE: f64 = 1e-4;

/// Do headings of a compass grow counter-clockwise, as those of the map, or clockwise, as those of a mirrored compass?
///
/// Both hypotheses predict the innovation of a heading $`z`$ from the predicted heading $`θ`$: $`z - θ`$, or $`-z - θ`$, each normal with the
/// innovation variance, or an outlier that is uniform on the circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadingSignTest(ProbabilityRatioTest);

impl Default for HeadingSignTest {
    fn default() -> Self {
        Self::from_log_odds(0.0).expect("invariant: the rate is a probability")
    }
}

impl HeadingSignTest {
    /// A test that continues from the log odds of an earlier one; 0 is a new one.
    pub fn from_log_odds(log_odds: f64) -> Result<Self, IntegrityError> {
        Ok(Self(ProbabilityRatioTest::from_error_rate(ERROR_RATE)?.with_sum(log_odds)?))
    }

    /// Takes a heading, rad, beside the one that is predicted without it, and the variance of their difference. Returns whether
    /// headings are known to have the right sign.
    ///
    /// # Errors
    /// Returns why headings cannot be used.
    fn admit(&mut self, measured: f64, predicted: f64, variance: f64) -> Result<bool, String> {
        let likelihood = |innovation: f64| {
            let nis = wrap_angle(innovation).powi(2) / variance;
            let normal = (-0.5 * nis).exp() / (TAU * variance).sqrt();
            (1.0 - ERROR_RATE) * normal + ERROR_RATE / TAU
        };
        let ratio = (likelihood(-measured - predicted) / likelihood(measured - predicted)).ln();
        match self.0.observe(ratio).map_err(|_| "heading is not finite".to_owned())? {
            RatioVerdict::First => Ok(true),
            RatioVerdict::Undecided => Ok(false),
            RatioVerdict::Second => Err(format!(
                "headings have the wrong sign, clockwise in place of counter-clockwise, with log odds of {:.1}",
                self.log_odds()
            )),
        }
    }

    /// Whether a heading may be used. Counts it otherwise.
    pub fn is_admitted(
        &mut self,
        measured: f64,
        predicted: f64,
        variance: f64,
        events: &mut EventCounts,
    ) -> bool {
        match self.admit(measured, predicted, variance) {
            Ok(is_known) => {
                events.add("measurement_withheld", u64::from(!is_known));
                is_known
            }
            Err(reason) => {
                events.refuse("measurement_gated", reason);
                false
            }
        }
    }

    /// Says if the compass is mirrored by all headings so far.
    pub fn warn_if_mirrored(&self, events: &mut EventCounts) {
        if self.0.verdict() == RatioVerdict::Second {
            events.warn(
                "compass_mirrored",
                "headings of the compass grow clockwise, by their innovations: they are not used (REP 103 counts counter-clockwise)",
            );
        }
    }

    /// Logarithm of the odds that the compass is mirrored.
    pub fn log_odds(&self) -> f64 {
        self.0.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VARIANCE: f64 = 0.05 * 0.05;

    fn test() -> HeadingSignTest {
        HeadingSignTest::default()
    }

    #[test]
    fn a_heading_across_the_axis_decides_both_signs() {
        assert_eq!(test().admit(0.5, 0.5, VARIANCE), Ok(true));
        let mut mirrored = test();
        assert!(mirrored.admit(-0.5, 0.5, VARIANCE).unwrap_err().contains("wrong sign"));
        // An outlier at the mirrored place delays the verdict and does not decide it.
        assert_eq!(mirrored.admit(0.5, 0.5, VARIANCE), Ok(false));
        assert_eq!(mirrored.admit(0.5, 0.5, VARIANCE), Ok(true));
    }

    #[test]
    fn headings_along_the_axis_leave_the_sign_open() {
        for heading in [0.0, std::f64::consts::PI] {
            let mut straight = test();
            assert_eq!((0..1000).map(|_| straight.admit(heading, heading, VARIANCE)).last(), Some(Ok(false)));
        }
    }

    #[test]
    fn headings_that_are_not_finite_change_nothing() {
        let mut compass = test();
        assert!(compass.admit(f64::NAN, 0.5, VARIANCE).is_err());
        assert!(compass.admit(0.5, 0.5, f64::NAN).is_err());
        assert_eq!(compass, test());
    }
}
