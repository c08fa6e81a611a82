use nalgebra::{Matrix3, Vector2};
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Data, Stamp, Velocity};
use wayfix_slam_ekf::{EkfSlam, ScaledPose, SlamError, Snapshot};

use super::{Save, SavedMap, SavedMapError, SavedState};
use crate::slam::{
    AssociationRule, SlamSystem, SlamSystemParams,
    system::{Past, Rule},
};
use crate::system::{MotionStatistics, check_velocity};

/// All that a [`SlamSystem`] remembers between two records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SystemState {
    /// Robot, map and covariance.
    pub filter: Snapshot<ScaledPose, Vector2<f64>>,
    /// How detections find their landmarks.
    pub association: AssociationRule,
    /// The number that the next new landmark gets, where association makes numbers up.
    pub next_id: Option<u32>,
    /// Stamp of the last record that was taken, nanoseconds; a resumed run leaves out what is not later.
    pub taken_until: u64,
    /// The time that the filter is at, nanoseconds: earlier, where the sensor is late.
    pub time: u64,
    /// Where odometry alone would put the robot.
    pub dead_reckoning: Pose2<f64>,
    /// What kind of odometry moves the robot; unknown before the first.
    pub odometry: Option<Odometry>,
    /// Commands that still act: nanoseconds, m/s, rad/s.
    pub commands: Vec<(u64, f64, f64)>,
    /// How the robot has moved by its commands.
    pub motion: MotionStatistics,
}

/// The kind of odometry that moves a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Odometry {
    /// Velocities, each held until the next.
    Velocities,
    /// Increments.
    Increments,
    /// Speed and steering of a car, each held until the next.
    Drives,
}

impl Odometry {
    /// The kind of a record; `None` when it is no odometry.
    pub(in crate::slam) fn of(data: &Data) -> Option<Self> {
        match data {
            Data::Velocity(_) => Some(Self::Velocities),
            Data::OdometryIncrement(_) => Some(Self::Increments),
            Data::Ackermann(_) => Some(Self::Drives),
            _ => None,
        }
    }
}

impl SavedState for SystemState {
    const ROBOT: (&str, usize) = ("planar pose with range scale", 4);
    const LANDMARK: (&str, usize) = ("point in the plane", 2);
}

impl Save for SlamSystem {
    type State = SystemState;
    fn save(&self) -> SavedMap {
        Self::save(self)
    }
}

impl SlamSystem {
    /// All that is needed to go on from here, with [`run_on`](crate::slam::run_on).
    pub fn save(&self) -> SavedMap {
        let (association, next_id) = match &self.association {
            Rule::Known(_) => (AssociationRule::Known, None),
            Rule::NearestNeighbour(rule) => (AssociationRule::Nn, Some(rule.next_id())),
            Rule::JointCompatibility(rule) => (AssociationRule::Jcbb, Some(rule.next_id())),
        };
        let command =
            |(stamp, velocity): (Stamp, Velocity)| (stamp.nanoseconds(), velocity.linear, velocity.angular);
        let state = SystemState {
            filter: self.filter.snapshot(),
            association,
            next_id,
            taken_until: self.past.taken_until.nanoseconds(),
            time: self.time.nanoseconds(),
            dead_reckoning: self.dead_reckoning,
            odometry: self.odometry,
            commands: self.commands.rows().map(command).collect(),
            motion: self.motion,
        };
        SavedMap { state }
    }

    /// The system that a map was saved of, with these parameters.
    pub(in crate::slam) fn resume(params: SlamSystemParams, saved: SavedMap) -> Result<Self, SavedMapError> {
        let SystemState {
            filter,
            association,
            next_id,
            taken_until,
            time,
            dead_reckoning,
            odometry,
            commands,
            motion,
        } = saved.state;
        check_association(params.association, association)?;
        let stamp = Stamp::from_nanoseconds;
        let mut system = Self::new(params, association, stamp(time), dead_reckoning, &Matrix3::zeros())?;
        let sensor = *system.filter.model();
        system.filter = EkfSlam::resume(sensor, *system.filter.params(), filter)?;
        match (&mut system.association, next_id) {
            (Rule::NearestNeighbour(rule), Some(next_id)) => *rule = rule.clone().numbering_from(next_id),
            (Rule::JointCompatibility(rule), Some(next_id)) => *rule = rule.clone().numbering_from(next_id),
            _ => {}
        }
        for (nanoseconds, linear, angular) in commands {
            let velocity = Velocity { linear, angular };
            let impossible = |_| SlamError::NotFinite { what: "saved command" };
            let velocity = check_velocity(velocity).map_err(impossible)?;
            system.commands.push(stamp(nanoseconds), velocity);
        }
        if !motion.is_finite() {
            return Err(SlamError::NotFinite { what: "saved motion" }.into());
        }
        (system.odometry, system.motion) = (odometry, motion);
        system.past = Past { taken_until: stamp(taken_until), resumed_at: Some(stamp(taken_until)) };
        Ok(system)
    }
}

/// Numbers that association made up are not those that a sensor reads.
pub(crate) fn check_association(
    asked: Option<AssociationRule>,
    saved: AssociationRule,
) -> Result<(), SavedMapError> {
    match asked {
        Some(asked) if asked != saved => Err(SavedMapError::Kind {
            what: "association",
            expected: format!("{asked:?}").to_lowercase(),
            found: format!("{saved:?}").to_lowercase(),
        }),
        _ => Ok(()),
    }
}
