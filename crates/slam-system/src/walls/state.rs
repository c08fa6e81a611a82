use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::LaserScan;
use wayfix_slam_ekf::{PoseWithHeadingDrift, SlamError, Wall};

use super::{
    WallSlamFrontEnd, WallSlamParams, WallSystem,
    odometry::OdometryBetweenScans,
    relative_motion::RelativeMotion,
    scan::{KeyframeScan, PlacedScan},
};
use crate::slam::{AssociationRule, FrontEndState, SavedMapError, SlamState, check_association};

/// A map of walls.
pub type SavedWallMap = SlamState<PoseWithHeadingDrift, Wall, WallFrontEndState>;

/// All that a [`WallSlamFrontEnd`] remembers between two records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallFrontEndState {
    /// Where the laser is on the robot.
    pub laser: Option<[f64; 3]>,
    /// Where the log placed it last, if the parameters do not.
    pub current_laser_mount: Option<Pose2<f64>>,
    /// Whether the log places it.
    pub laser_follows_log: bool,
    /// Whether velocities move the robot, and not increments.
    pub moves_by_velocity: bool,
    /// How far odometry is used, and the velocity that holds.
    pub odometry: OdometryBetweenScans,
    /// The motion since the last keyframe.
    pub relative_motion: RelativeMotion,
    /// The scan of the last keyframe.
    pub last_keyframe: Option<SavedScan>,
}

/// A scan and where the laser was.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedScan {
    /// Bearing of the first beam, rad.
    pub angle_min: f64,
    /// From a beam to the next, rad.
    pub angle_increment: f64,
    /// From here on a range is no echo, m.
    pub range_max: f64,
    /// Ranges, m.
    pub ranges: Vec<f64>,
    /// Where the laser was on the robot.
    pub laser: Pose2<f64>,
    /// How it moved from beam to beam.
    pub beam_step: Option<Pose2<f64>>,
}

impl FrontEndState for WallFrontEndState {
    const ROBOT: (&str, usize) = ("planar pose with heading drift", 4);
    const LANDMARK: (&str, usize) = ("wall in the plane", 2);
}

impl WallFrontEndState {
    pub(super) fn of(front_end: &WallSlamFrontEnd) -> Self {
        Self {
            laser: front_end.params.laser_pose,
            current_laser_mount: front_end.current_laser_mount,
            laser_follows_log: front_end.laser_follows_log,
            moves_by_velocity: front_end.moves_by_velocity,
            odometry: front_end.odometry,
            relative_motion: front_end.relative_motion,
            last_keyframe: front_end.last_keyframe.as_ref().map(SavedScan::of),
        }
    }

    fn check(&self) -> Result<(), SavedMapError> {
        let refuse = |what| Err(SavedMapError::from(SlamError::NotFinite { what }));
        if !self.relative_motion.is_finite() {
            return refuse("saved motion since the last keyframe");
        }
        if !self.odometry.is_finite() || self.current_laser_mount.is_some_and(|laser| !laser.is_finite()) {
            return refuse("saved odometry");
        }
        Ok(())
    }
}

impl SavedScan {
    fn of(KeyframeScan { scan: PlacedScan { scan, laser, beam_step }, .. }: &KeyframeScan) -> Self {
        Self {
            angle_min: scan.angle_min,
            angle_increment: scan.angle_increment,
            range_max: scan.range_max,
            ranges: scan.ranges.clone(),
            laser: *laser,
            beam_step: *beam_step,
        }
    }

    fn keyframe(self) -> Result<KeyframeScan, SavedMapError> {
        let Self { angle_min, angle_increment, range_max, ranges, laser, beam_step } = self;
        let scan = LaserScan { angle_min, angle_increment, range_max, beam_period: 0.0, ranges };
        let scan = PlacedScan { scan, laser, beam_step };
        let invalid = |_| SavedMapError::from(SlamError::NotFinite { what: "saved scan" });
        let cloud = scan.cloud().map_err(invalid)?;
        Ok(KeyframeScan { scan, cloud })
    }
}

impl WallSystem {
    /// The system of a saved map, with these parameters; the laser is where it was, unless they place it.
    ///
    /// # Errors
    /// Returns an error if the map has another association rule, or holds invalid numbers.
    pub(super) fn resume(
        params: WallSlamParams,
        saved: SavedWallMap,
        asked: Option<AssociationRule>,
    ) -> anyhow::Result<Self> {
        let SlamState {
            filter,
            smoothed: _,
            association,
            next_id,
            taken_until,
            dead_reckoning,
            external,
            front_end: state,
        } = saved;
        check_association(asked, association)?;
        state.check()?;
        let laser_follows_log = params.laser_pose.is_none() && state.laser_follows_log;
        let laser = params.laser_pose.or(state.laser);
        let params = WallSlamParams { association, laser_pose: laser, ..params };
        let mut system =
            Self::with_walls(params, dead_reckoning, &Matrix3::zeros(), state.moves_by_velocity)?;
        let front_end = &mut system.front_end;
        front_end.relative_motion = state.relative_motion;
        front_end.last_keyframe = state.last_keyframe.map(SavedScan::keyframe).transpose()?;
        front_end.odometry = state.odometry;
        (front_end.current_laser_mount, front_end.laser_follows_log) =
            (state.current_laser_mount, laser_follows_log);
        Ok(system.resumed(filter, next_id, taken_until, external)?)
    }
}
