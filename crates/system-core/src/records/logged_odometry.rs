use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Record, RecordData, Stamp};
use wayfix_slam_ekf::MotionStatistics;

use super::{EventCounts, HeldVelocity, IncrementPlausibilityCheck, check_velocity};

/// Larger differences of the scale of odometry from 1 are no matter of calibration: an uncalibrated wheeled robot errs by a few percent. [Borenstein & Feng 1996]
pub const ODOMETRY_SCALE_TOLERANCE: f64 = 0.2;

/// The kind of odometry that moves a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OdometryRecordKind {
    /// Velocities, each held until the next.
    Velocities,
    /// Increments.
    Increments,
    /// Speed and steering of a car, each held until the next.
    Drives,
}

impl OdometryRecordKind {
    /// The kind of a record; `None` when it is no odometry.
    pub fn of(data: &RecordData) -> Option<Self> {
        match data {
            RecordData::Velocity(_) => Some(Self::Velocities),
            RecordData::OdometryIncrement(_) => Some(Self::Increments),
            RecordData::Ackermann(_) => Some(Self::Drives),
            _ => None,
        }
    }
}

/// The motion of a robot by the increments or the velocities of a log.
///
/// If a log records its motion in both kinds, the kind that comes first moves the robot, and the other is counted and ignored. A velocity holds until the
/// next, at most for the time-out; the motion after that is unknown. Drives of a car are not followed.
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{Record, RecordData, Stamp, Velocity};
/// use wayfix_system_core::{EventCounts, LoggedOdometry};
/// let record = |seconds, data| Record { stamp: Stamp::from_seconds(seconds).unwrap(), data };
/// let forward = record(0.0, RecordData::Velocity(Velocity { linear: 0.5, angular: 0.0 }));
/// let same_motion = record(0.5, RecordData::OdometryIncrement(Pose2::new(0.25, 0.0, 0.0)));
/// let (mut odometry, mut events) = (LoggedOdometry::new(1.0), EventCounts::default());
/// assert!(odometry.take(&forward, &mut events)?.is_none()); // it moves the robot from here on
/// assert!(odometry.take(&same_motion, &mut events)?.is_none());
/// let motion = odometry.advance_to(Stamp::from_seconds(3.0).unwrap(), &mut events).unwrap();
/// assert!((motion.increment.x() - 0.5).abs() < 1e-12 && (motion.unknown_seconds - 2.0).abs() < 1e-9);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
pub struct LoggedOdometry {
    velocity_timeout: f64,
    kind: Option<OdometryRecordKind>,
    plausible: IncrementPlausibilityCheck,
    velocity: HeldVelocity,
    last_increment: Option<Stamp>,
    /// Whether the motion was asked for when the last increment was older than the time-out.
    is_used_in_gap: bool,
    statistics: MotionStatistics,
    /// Time since the velocity expired, s.
    unknown_seconds: f64,
}

/// A motion that odometry measured, and the time after it in which it did not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoggedMotion {
    /// In the robot frame before it.
    pub increment: Pose2<f64>,
    /// Time without a measured motion, s.
    pub unknown_seconds: f64,
    /// Covariance of the motion in that time, m² and rad²: at the RMS speed and turn rate so far, in an unknown direction.
    pub unknown_covariance: Matrix3<f64>,
}

impl LoggedOdometry {
    /// Odometry whose velocities hold for at most `velocity_timeout`, s.
    pub fn new(velocity_timeout: f64) -> Self {
        Self {
            velocity_timeout,
            kind: None,
            plausible: IncrementPlausibilityCheck::default(),
            velocity: HeldVelocity::default(),
            last_increment: None,
            is_used_in_gap: false,
            statistics: MotionStatistics::default(),
            unknown_seconds: 0.0,
        }
    }

    /// Takes a record. Returns the motion up to its stamp, if it is odometry and there is any.
    ///
    /// # Errors
    /// Returns a description of an impossible motion, which is left out.
    pub fn take(
        &mut self,
        record: &Record,
        events: &mut EventCounts,
    ) -> Result<Option<LoggedMotion>, String> {
        let kind = OdometryRecordKind::of(&record.data);
        if let (Some(kind), Some(moves)) = (kind, self.kind)
            && kind != moves
        {
            events.count("second_odometry_source_ignored");
            return Ok(None);
        }
        match &record.data {
            RecordData::OdometryIncrement(increment) => {
                self.plausible.check(record.stamp, increment)?;
                self.kind = kind;
                self.add_increment(record.stamp, increment, events);
                let (unknown_seconds, unknown_covariance) = (0.0, Matrix3::zeros());
                Ok(Some(LoggedMotion { increment: *increment, unknown_seconds, unknown_covariance }))
            }
            RecordData::Velocity(velocity) => {
                check_velocity(*velocity)?;
                self.kind = kind;
                let motion = self.advance_to(record.stamp, events);
                self.velocity.hold(record.stamp, *velocity)?;
                self.unknown_seconds = 0.0;
                Ok(motion)
            }
            _ => Ok(None),
        }
    }

    /// Says when the robot has moved in a gap of the increments in which its motion was asked for: farther than at its RMS speed and turn rate until the time-out.
    fn add_increment(&mut self, stamp: Stamp, increment: &Pose2<f64>, events: &mut EventCounts) {
        let Some(last) = self.last_increment.replace(stamp) else { return };
        let timeout = self.velocity_timeout;
        let usual = self.statistics.unknown_motion(timeout);
        let has_moved =
            increment.translation.norm_squared() > usual.m11 || increment.heading().powi(2) > usual.m33;
        if std::mem::take(&mut self.is_used_in_gap) && has_moved {
            events.warn(
                "motion_unknown",
                format!("odometry is missing for more than {timeout} s while the robot moves: the motion is unknown there"),
            );
        }
        self.statistics.add(increment, stamp.seconds_since(last));
    }

    /// The kind that moves the robot; `None` before the first record.
    pub fn kind(&self) -> Option<OdometryRecordKind> {
        self.kind
    }

    /// The motion by the velocity that holds, from the last call to `stamp`.
    pub fn advance_to(&mut self, stamp: Stamp, events: &mut EventCounts) -> Option<LoggedMotion> {
        self.is_used_in_gap |=
            self.last_increment.is_some_and(|last| stamp.seconds_since(last) > self.velocity_timeout);
        let held = self.velocity.motion_until(stamp, self.velocity_timeout)?;
        self.statistics.add(&held.increment, held.seconds);
        if held.unknown_seconds > 0.0 {
            let timeout = self.velocity_timeout;
            events.warn(
                "motion_unknown",
                format!("velocities are missing for more than {timeout} s: the motion is unknown there"),
            );
        }
        let before = self.statistics.unknown_motion(self.unknown_seconds);
        self.unknown_seconds += held.unknown_seconds;
        Some(LoggedMotion {
            increment: held.increment,
            unknown_seconds: held.unknown_seconds,
            // The direction stays the same: the covariance grows with the square of the time, however often it is asked for.
            unknown_covariance: self.statistics.unknown_motion(self.unknown_seconds) - before,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a second of driving, five seconds without increments, with images or without, and an increment over that time are said to hold unknown motion.
    fn is_said(distance: f64, has_images: bool) -> bool {
        let (mut odometry, mut events) = (LoggedOdometry::new(1.0), EventCounts::default());
        let stamp = |seconds: f64| Stamp::from_seconds(seconds).unwrap();
        let increment = |seconds: f64, x: f64| Record {
            stamp: stamp(seconds),
            data: RecordData::OdometryIncrement(Pose2::new(x, 0.0, 0.0)),
        };
        for step in 0..=10 {
            odometry.take(&increment(0.1 * f64::from(step), 0.05), &mut events).unwrap();
        }
        if has_images {
            assert_eq!(odometry.advance_to(stamp(3.0), &mut events), None);
        }
        odometry.take(&increment(6.0, distance), &mut events).unwrap();
        events.get("motion_unknown") == 1
    }

    #[test]
    fn motion_in_a_gap_of_the_increments_is_said_and_rest_is_not() {
        assert!(is_said(2.5, true));
        assert!(!is_said(2.5, false)); // as slow as the images
        assert!(!is_said(0.05, true)); // a source that is silent while the robot stands
    }
}
