use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{Stamp, Velocity};
use wayfix_system_core::HeldVelocity;

use wayfix_slam_ekf::MotionStatistics;

/// The motion in a log, cut at the stamps of the scans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OdometryBetweenScans {
    /// Stamp of the last increment, nanoseconds.
    known_until: Option<u64>,
    /// The motion up to here is used, nanoseconds; nothing before the first scan is.
    used_until: Option<u64>,
    velocity: HeldVelocity,
    statistics: MotionStatistics,
    /// Motion a second by the last increment or velocity, m/s and rad/s, in the robot's frame.
    twist: Option<Vector3<f64>>,
}

/// A motion, and its possible error in addition to the noise of odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motion {
    pub(super) increment: Pose2<f64>,
    pub(super) error: Matrix3<f64>,
    /// Time without a measured motion, s.
    pub(super) unknown_seconds: f64,
}

impl OdometryBetweenScans {
    /// Whether increments reach to this stamp.
    pub(super) fn reaches(&self, stamp: Stamp) -> bool {
        self.known_until.is_some_and(|known| stamp.nanoseconds() <= known)
    }

    /// Whether the robot has started, at the first scan.
    pub(super) fn has_started(&self) -> bool {
        self.used_until.is_some()
    }

    /// Nothing before this stamp moves the robot.
    pub(super) fn start(&mut self, stamp: Stamp) {
        self.used_until = Some(stamp.nanoseconds());
    }

    /// The parts of an increment that ends at `end`: up to each of the ascending `cuts`, and from the last to the end. What lies before
    /// [`start`](Self::start), or was used before, is left out.
    ///
    /// The first increment of a log does not say where it begins: it begins at the last of the cuts.
    pub(super) fn cut(&mut self, increment: &Pose2<f64>, end: Stamp, cuts: &[Stamp]) -> Vec<Motion> {
        let end = end.nanoseconds();
        let cuts: Vec<u64> = cuts.iter().map(|cut| cut.nanoseconds()).collect();
        let is_first = self.known_until.is_none();
        let begin = self.known_until.or(cuts.last().copied()).unwrap_or(end).min(end);
        self.known_until = Some(end);
        let seconds = |from: u64, to: u64| to.saturating_sub(from) as f64 * 1e-9;
        let whole = seconds(begin, end);
        let mut left = if is_first && begin == end { 0.0 } else { 1.0 };
        let mut from = self.used_until.unwrap_or(begin).max(begin);
        let mut share_up_to = |to: u64| {
            let share = if whole > 0.0 {
                seconds(from, to) / whole
            } else if to == end {
                left
            } else {
                0.0
            };
            (from, left) = (from.max(to), left - share);
            share
        };
        let twist = increment.log();
        let motion = |to: u64| {
            let share = share_up_to(to);
            let increment = if share == 1.0 { *increment } else { Pose2::exp(&(twist * share)) };
            let error = self.statistics.interpolation(seconds(begin, to), seconds(to, end));
            Motion { increment, error, unknown_seconds: 0.0 }
        };
        let motions = cuts.into_iter().chain([end]).map(motion).collect();
        self.used_until = self.used_until.map(|used| used.max(end));
        self.statistics.add(increment, whole);
        if whole > 0.0 {
            self.twist = Some(twist / whole);
        }
        motions
    }

    /// The motion up to a scan that increments do not reach: unknown since they ended.
    pub(super) fn unknown_until(&mut self, stamp: Stamp) -> Motion {
        let now = stamp.nanoseconds();
        let seconds = now.saturating_sub(self.used_until.unwrap_or(now)) as f64 * 1e-9;
        self.used_until = Some(now.max(self.used_until.unwrap_or(now)));
        let error = self.statistics.unknown_motion(seconds);
        self.twist = None;
        Motion { increment: Pose2::identity(), error, unknown_seconds: seconds }
    }

    /// The motion up to `stamp` by the velocity that holds; `None` when no time has passed.
    pub(super) fn held_until(&mut self, stamp: Stamp, longest: f64) -> Option<Motion> {
        let held = self.velocity.motion_until(stamp, longest)?;
        self.statistics.add(&held.increment, held.seconds);
        let error = self.statistics.unknown_motion(held.unknown_seconds);
        if held.unknown_seconds > 0.0 {
            self.twist = None;
        }
        Some(Motion { increment: held.increment, error, unknown_seconds: held.unknown_seconds })
    }

    /// Holds a velocity from `stamp` on.
    ///
    /// # Errors
    /// When no robot is so fast; the one before holds on.
    pub(super) fn hold(&mut self, stamp: Stamp, velocity: Velocity) -> Result<(), String> {
        self.velocity.hold(stamp, velocity)?;
        self.twist = Some(Vector3::new(velocity.linear, 0.0, velocity.angular));
        Ok(())
    }

    /// Motion a second, m/s and rad/s, in the robot's frame; `None` before odometry gives any.
    pub(super) fn twist(&self) -> Option<Vector3<f64>> {
        self.twist
    }

    /// Whether every number is one.
    pub(super) fn is_finite(&self) -> bool {
        self.statistics.is_finite()
            && self.twist.is_none_or(|twist| twist.iter().all(|rate| rate.is_finite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    fn forward(motions: &[Motion]) -> Vec<f64> {
        motions.iter().map(|motion| motion.increment.x()).collect()
    }

    #[test]
    fn increment_is_cut_at_the_scans_in_proportion_to_time() {
        let mut odometry = OdometryBetweenScans::default();
        odometry.cut(&Pose2::new(9.0, 0.0, 0.0), at(1000), &[]);
        odometry.start(at(1000));
        let motions = odometry.cut(&Pose2::new(1.0, 0.0, 0.0), at(2000), &[at(1100), at(1400)]);
        let expected = [0.1, 0.3, 0.6];
        assert!(forward(&motions).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{motions:?}");
    }

    #[test]
    fn motion_before_the_first_scan_is_left_out() {
        let mut odometry = OdometryBetweenScans::default();
        odometry.cut(&Pose2::new(9.0, 0.0, 0.0), at(1000), &[]);
        odometry.start(at(1500));
        let motions = odometry.cut(&Pose2::new(1.0, 0.0, 0.0), at(2000), &[at(1500)]);
        assert!(forward(&motions).iter().zip([0.0, 0.5]).all(|(a, b)| (a - b).abs() < 1e-12), "{motions:?}");
    }

    #[test]
    fn increment_at_the_stamp_of_the_one_before_is_used_once() {
        let mut odometry = OdometryBetweenScans::default();
        odometry.cut(&Pose2::new(9.0, 0.0, 0.0), at(1000), &[]);
        odometry.start(at(1000));
        let motions = odometry.cut(&Pose2::new(1.0, 0.0, 0.0), at(1000), &[at(1000)]);
        assert_eq!(forward(&motions), [1.0, 0.0]);
    }

    #[test]
    fn motion_is_unknown_where_increments_have_ended() {
        let mut odometry = OdometryBetweenScans::default();
        odometry.cut(&Pose2::new(0.5, 0.0, 0.0), at(0), &[]);
        odometry.start(at(0));
        odometry.cut(&Pose2::new(0.5, 0.0, 0.0), at(1000), &[]);
        let motion = odometry.unknown_until(at(3000));
        assert_eq!((motion.increment, motion.unknown_seconds), (Pose2::identity(), 2.0));
        assert!(abs_diff_eq!(motion.error.m11, 1.0, epsilon = 1e-12), "0.5 m/s for 2 s");
        let rest = odometry.cut(&Pose2::new(4.0, 0.0, 0.0), at(5000), &[]);
        assert!(
            abs_diff_eq!(rest[0].increment.x(), 2.0, epsilon = 1e-12),
            "what came before 3 s is used up: {rest:?}"
        );
    }
}
