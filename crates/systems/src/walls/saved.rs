use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{LaserScan, Stamp};
use wayfix_slam_ekf::{DriftingPose, EkfSlam, SlamError, Snapshot, Wall};

use super::{
    WallSlamParams, WallSystem,
    odometry::Odometry,
    relative_motion::RelativeMotion,
    scan::{KeyframeScan, PlacedScan, WaitingScan},
    system::Rule,
};
use crate::slam::{AssociationRule, Save, Saved, SavedMapError, SavedState, check_association};

/// All that a [`WallSystem`] remembers between two records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallState {
    /// Robot, walls and covariance.
    pub filter: Snapshot<DriftingPose, Wall>,
    /// How pieces of walls find their walls.
    pub association: AssociationRule,
    /// The number that the next new wall gets.
    pub next_id: u32,
    /// Stamp of the last record that was taken, nanoseconds; a resumed run leaves out what is not later.
    pub taken_until: u64,
    /// Where odometry alone would put the robot.
    pub dead_reckoning: Pose2<f64>,
    /// Where the laser sits on the robot.
    pub laser: Option<[f64; 3]>,
    /// Where it was at last, where the log says it and the parameters do not.
    pub current_laser_mount: Option<Pose2<f64>>,
    /// Whether the log places it.
    pub laser_follows_log: bool,
    /// Whether velocities move the robot, and not increments.
    pub moves_by_velocity: bool,
    /// How far odometry is used, and the velocity that holds.
    pub odometry: Odometry,
    /// The way since the last look.
    pub relative_motion: RelativeMotion,
    /// The scan of the last look.
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

impl SavedState for WallState {
    const ROBOT: (&str, usize) = ("planar pose with heading drift", 4);
    const LANDMARK: (&str, usize) = ("wall in the plane", 2);
}

impl Save for WallSystem {
    type State = WallState;
    fn save(&self) -> Saved<WallState> {
        let (association, next_id) = match &self.association {
            Rule::NearestNeighbour(rule) => (AssociationRule::Nn, rule.next_id()),
            Rule::JointCompatibility(rule) => (AssociationRule::Jcbb, rule.next_id()),
        };
        let scan =
            |KeyframeScan { scan: PlacedScan { scan, laser, beam_step }, .. }: &KeyframeScan| SavedScan {
                angle_min: scan.angle_min,
                angle_increment: scan.angle_increment,
                range_max: scan.range_max,
                ranges: scan.ranges.clone(),
                laser: *laser,
                beam_step: *beam_step,
            };
        Saved {
            state: WallState {
                filter: self.filter.snapshot(),
                association,
                next_id,
                taken_until: self.settled_until().nanoseconds(),
                dead_reckoning: self.dead_reckoning,
                laser: self.params.laser,
                current_laser_mount: self.current_laser_mount,
                laser_follows_log: self.laser_follows_log,
                moves_by_velocity: self.moves_by_velocity,
                odometry: self.odometry,
                relative_motion: self.relative_motion,
                last_keyframe: self.last_keyframe.as_ref().map(scan),
            },
        }
    }
}

impl WallSystem {
    /// Stamp of the last record that changed the state: scans that wait for their odometry come later.
    fn settled_until(&self) -> Stamp {
        let before =
            |waiting: &WaitingScan| Stamp::from_nanoseconds(waiting.stamp.nanoseconds().saturating_sub(1));
        self.waiting.front().map_or(self.taken_until, before)
    }

    /// The system that a map was saved of, with these parameters; the laser sits where it sat, unless they place it.
    pub(super) fn resume(
        params: WallSlamParams,
        saved: Saved<WallState>,
        asked: Option<AssociationRule>,
    ) -> anyhow::Result<Self> {
        let WallState { filter, association, next_id, taken_until, relative_motion, last_keyframe, .. } =
            saved.state;
        check_association(asked, association)?;
        let laser_follows_log = params.laser.is_none() && saved.state.laser_follows_log;
        let laser = params.laser.or(saved.state.laser);
        let params = WallSlamParams { association, laser, ..params };
        let start = saved.state.dead_reckoning;
        let mut system = Self::new(params, start, &Matrix3::zeros(), saved.state.moves_by_velocity)?;
        let (sensor, filter_params) = (*system.filter.model(), *system.filter.params());
        system.filter = EkfSlam::resume(sensor, filter_params, filter).map_err(SavedMapError::from)?;
        system.association = match system.association {
            Rule::NearestNeighbour(rule) => Rule::NearestNeighbour(rule.numbering_from(next_id)),
            Rule::JointCompatibility(rule) => Rule::JointCompatibility(rule.numbering_from(next_id)),
        };
        if !relative_motion.is_finite() {
            return Err(
                SavedMapError::from(SlamError::NotFinite { what: "saved way since the last look" }).into()
            );
        }
        system.relative_motion = relative_motion;
        if let Some(SavedScan { angle_min, angle_increment, range_max, ranges, laser, beam_step }) =
            last_keyframe
        {
            let scan = LaserScan { angle_min, angle_increment, range_max, beam_period: 0.0, ranges };
            let scan = PlacedScan { scan, laser, beam_step };
            let unsound = |_| SavedMapError::from(SlamError::NotFinite { what: "saved scan" });
            let cloud = scan.cloud().map_err(unsound)?;
            system.last_keyframe = Some(KeyframeScan { scan, cloud });
        }
        if !saved.state.odometry.is_finite()
            || saved.state.current_laser_mount.is_some_and(|laser| !laser.is_finite())
        {
            return Err(SavedMapError::from(SlamError::NotFinite { what: "saved odometry" }).into());
        }
        system.odometry = saved.state.odometry;
        (system.current_laser_mount, system.laser_follows_log) =
            (saved.state.current_laser_mount, laser_follows_log);
        system.taken_until = Stamp::from_nanoseconds(taken_until);
        system.resumed_at = Some(system.taken_until);
        Ok(system)
    }
}
