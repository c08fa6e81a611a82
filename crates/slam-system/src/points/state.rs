use nalgebra::{Matrix3, Vector2};
use serde::{Deserialize, Serialize};
use wayfix_sensor_log::{Stamp, Velocity};
use wayfix_slam_ekf::MotionStatistics;
use wayfix_slam_ekf::{PoseWithRangeScale, SlamError};
use wayfix_system_core::{OdometryRecordKind, check_velocity};

use super::{PointSlamFrontEnd, PointSlamParams, PointSystem};
use crate::slam::{FrontEndState, SavedMapError, SlamState, Smoothing, check_association};

/// A map of points.
pub type SavedPointMap = SlamState<PoseWithRangeScale, Vector2<f64>, PointFrontEndState>;

/// All that a [`PointSlamFrontEnd`] remembers between two records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointFrontEndState {
    /// The time of the filter's state, nanoseconds: earlier than the last record where the sensor is late.
    pub time: u64,
    /// The kind of odometry that moves the robot; unknown before the first.
    pub odometry: Option<OdometryRecordKind>,
    /// Commands that still act: nanoseconds, m/s, rad/s.
    pub commands: Vec<(u64, f64, f64)>,
    /// How the robot has moved by its commands.
    pub motion: MotionStatistics,
}

impl FrontEndState for PointFrontEndState {
    const ROBOT: (&str, usize) = ("planar pose with range scale", 4);
    const LANDMARK: (&str, usize) = ("point in the plane", 2);
}

impl PointFrontEndState {
    pub(super) fn of(front_end: &PointSlamFrontEnd) -> Self {
        let command =
            |(stamp, velocity): (Stamp, Velocity)| (stamp.nanoseconds(), velocity.linear, velocity.angular);
        Self {
            time: front_end.time.nanoseconds(),
            odometry: front_end.odometry,
            commands: front_end.commands.rows().map(command).collect(),
            motion: front_end.motion,
        }
    }
}

impl PointSystem {
    /// The system of a saved map, with these parameters.
    ///
    /// # Errors
    /// Returns an error if the map has another association rule, or holds invalid numbers.
    pub(super) fn resume(params: PointSlamParams, saved: SavedPointMap) -> Result<Self, SavedMapError> {
        let SlamState {
            filter,
            smoothed,
            association,
            next_id,
            taken_until,
            dead_reckoning,
            external,
            front_end,
        } = saved;
        let PointFrontEndState { time, odometry, commands, motion } = front_end;
        check_association(params.association, association)?;
        let stamp = Stamp::from_nanoseconds;
        let mut system =
            Self::with_points(params, association, stamp(time), dead_reckoning, &Matrix3::zeros())?;
        for (nanoseconds, linear, angular) in commands {
            let velocity = Velocity { linear, angular };
            let impossible = |_| SlamError::NotFinite { what: "saved command" };
            let velocity = check_velocity(velocity).map_err(impossible)?;
            system.front_end.commands.push(stamp(nanoseconds), velocity);
        }
        if !motion.is_finite() {
            return Err(SlamError::NotFinite { what: "saved motion" }.into());
        }
        (system.front_end.odometry, system.front_end.motion) = (odometry, motion);
        let mut system = system.resumed(filter, next_id, taken_until, external)?;
        if system.front_end.params.smoothing == Smoothing::FixedLag {
            if smoothed.is_none() {
                system.estimator.events.warn(
                    "smoother_starts_from_filter",
                    "the saved map is of a filter alone: the smoother starts from its estimate",
                );
            }
            system.follow(smoothed)?;
        }
        Ok(system)
    }
}
