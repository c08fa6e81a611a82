use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;

/// Statistics of the robot's motion so far. They bound its motion while odometry is missing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionStatistics {
    /// Time with a known motion, s.
    seconds: f64,
    /// Integrals of the squared speed and turn rate.
    squared_rates: [f64; 2],
    /// Integrals of the squared changes of both, and their total time, s.
    squared_changes: [f64; 2],
    seconds_of_changes: f64,
    /// Speed and turn rate of the last increment.
    last: Option<[f64; 2]>,
}

impl MotionStatistics {
    /// Adds an increment that lasts `seconds`.
    pub fn add(&mut self, increment: &Pose2<f64>, seconds: f64) {
        if seconds.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return;
        }
        let rates = [increment.translation.norm() / seconds, increment.heading() / seconds];
        for axis in 0..2 {
            self.squared_rates[axis] += rates[axis].powi(2) * seconds;
            if let Some(last) = self.last {
                self.squared_changes[axis] += ((rates[axis] - last[axis]) / seconds).powi(2) * seconds;
            }
        }
        if self.last.is_some() {
            self.seconds_of_changes += seconds;
        }
        self.seconds += seconds;
        self.last = Some(rates);
    }

    /// Covariance of an unknown motion over `seconds`: the robot moves at its RMS speed and turn rate in an unknown direction.
    pub fn unknown_motion(&self, seconds: f64) -> Matrix3<f64> {
        self.covariance(self.squared_rates, self.seconds, seconds)
    }

    /// Covariance of a motion interpolated `before` seconds after one odometry record and `after` seconds before the next.
    ///
    /// A constant acceleration $`a`$ deviates from linear interpolation by $`\tfrac{1}{2} a\, t_1 t_2`$; $`a`$ is the RMS acceleration so far.
    pub fn interpolation(&self, before: f64, after: f64) -> Matrix3<f64> {
        self.covariance(self.squared_changes, self.seconds_of_changes, 0.5 * before * after)
    }

    /// Whether every number is finite; used to check a saved state.
    pub fn is_finite(&self) -> bool {
        let numbers =
            self.squared_rates.iter().chain(&self.squared_changes).chain(self.last.iter().flatten());
        let mut numbers = numbers.chain([&self.seconds, &self.seconds_of_changes]);
        numbers.all(|number| number.is_finite())
    }

    fn covariance(&self, squares: [f64; 2], seconds: f64, factor: f64) -> Matrix3<f64> {
        if seconds == 0.0 {
            return Matrix3::zeros();
        }
        let [translation, heading] = squares.map(|square| square / seconds * factor * factor);
        Matrix3::from_diagonal(&Vector3::new(translation, translation, heading))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn unknown_motion_has_the_rms_speed() {
        let mut statistics = MotionStatistics::default();
        assert_eq!(statistics.unknown_motion(5.0), Matrix3::zeros());
        statistics.add(&Pose2::new(0.5, 0.0, 0.1), 1.0);
        statistics.add(&Pose2::new(0.0, 0.0, 0.0), 1.0);
        let covariance = statistics.unknown_motion(2.0);
        assert_abs_diff_eq!(covariance.m11, 0.5 * 0.25 * 4.0, epsilon = 1e-12);
        assert_abs_diff_eq!(covariance.m33, 0.5 * 0.01 * 4.0, epsilon = 1e-12);
    }

    #[test]
    fn interpolation_is_exact_at_the_records_and_for_constant_speed() {
        let mut statistics = MotionStatistics::default();
        for speed in [1.0, 1.0, 1.0] {
            statistics.add(&Pose2::new(speed, 0.0, 0.0), 1.0);
        }
        assert_eq!(statistics.interpolation(0.5, 0.5), Matrix3::zeros());
        statistics.add(&Pose2::new(2.0, 0.0, 0.0), 1.0);
        assert_eq!(statistics.interpolation(0.0, 1.0), Matrix3::zeros());
        assert!(statistics.interpolation(0.5, 0.5).m11 > 0.0);
    }
}
