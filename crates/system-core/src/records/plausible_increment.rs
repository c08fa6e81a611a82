use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::Stamp;

use crate::MAX_SPEED;

/// Largest accepted distance between two records, m, if the time between them is unknown.
const FARTHEST: f64 = 1e5;
/// Assumed stamp jitter of drivers, s.
const JITTER: f64 = 0.01;

/// Rejects odometry increments that are physically impossible.
#[derive(Clone, Copy, Debug, Default)]
pub struct IncrementPlausibilityCheck {
    last: Option<Stamp>,
}

impl IncrementPlausibilityCheck {
    /// Checks an increment that ends at `stamp` and begins at the last accepted one.
    ///
    /// # Errors
    /// Returns a description if the increment is not finite or exceeds [`MAX_SPEED`]; the last accepted stamp stays.
    pub fn check(&mut self, stamp: Stamp, increment: &Pose2<f64>) -> Result<(), String> {
        let seconds = self.last.map(|last| stamp.seconds_since(last).max(0.0));
        let farthest = seconds.map_or(FARTHEST, |seconds| (MAX_SPEED * (seconds + JITTER)).min(FARTHEST));
        let (x, y, turn) = (increment.x(), increment.y(), increment.heading());
        if x.hypot(y) <= farthest && turn.is_finite() {
            self.last = Some(stamp);
            return Ok(());
        }
        Err(format!(
            "an increment of ({x:.3e} m, {y:.3e} m, {turn:.3e} rad) is farther than {farthest} m or not finite"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    #[test]
    fn absurd_increment_is_refused_and_the_next_one_passes() {
        for x in [1e256, -1e200, f64::NAN, f64::INFINITY, 1e4] {
            let mut plausible = IncrementPlausibilityCheck::default();
            plausible.check(at(0), &Pose2::new(0.1, 0.0, 0.0)).unwrap();
            let error = plausible.check(at(100), &Pose2::new(x, 0.0, 0.0)).unwrap_err();
            assert!(error.len() < 120, "{error}");
            plausible.check(at(200), &Pose2::new(0.1, 0.0, 0.0)).unwrap();
        }
    }

    #[test]
    fn increments_of_equal_stamps_pass() {
        let mut plausible = IncrementPlausibilityCheck::default();
        for _ in 0..3 {
            plausible.check(at(7), &Pose2::new(1.0, 0.0, 3.0)).unwrap();
        }
    }
}
