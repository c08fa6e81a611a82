use std::time::Duration;

use nalgebra::{Matrix4, Vector3, Vector4};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_line_extract::{Extractor, Scan};
use wayfix_sensor_log::{Data, LaserScan, Record, Stamp, Velocity};
use wayfix_slam_ekf::{
    DriftingMotion, DriftingPose, EkfSlam, JointCompatibility, LandmarkId, Mounted, NearestNeighbour,
    Observation, OnDrifting, SeenWall, SlamError, StepReport, Wall, WallSensor,
};

use super::WallSlamParams;
use crate::{
    slam::{AssociationRule, Keyframe, event_name},
    system::{Events, Stopwatch, System},
};

/// Walls seen by a laser that may sit anywhere on a robot whose odometry may drift.
pub type WallModel = OnDrifting<Mounted<WallSensor>>;

/// EKF-SLAM that takes scans and keeps a map of walls.
pub struct WallSystem {
    params: WallSlamParams,
    moves_by_velocity: bool,
    extractor: Extractor,
    filter: EkfSlam<WallModel>,
    association: Rule,
    time: Stamp,
    /// The velocity that holds, and since when: only where a log has no increments.
    velocity: Option<(Stamp, Velocity)>,
    dead_reckoning: Pose2<f64>,
    keyframes: Vec<Keyframe>,
    events: Events,
    step: Duration,
}

enum Rule {
    NearestNeighbour(NearestNeighbour),
    JointCompatibility(JointCompatibility),
}

impl WallSystem {
    /// A robot at `start` among walls that it does not know; its motion is told by velocities, else by increments.
    ///
    /// # Errors
    /// When a parameter is out of range.
    pub(super) fn new(
        params: WallSlamParams,
        start: Pose2<f64>,
        moves_by_velocity: bool,
    ) -> anyhow::Result<Self> {
        let params = params.validated()?;
        let association = match params.association {
            AssociationRule::Jcbb => {
                Rule::JointCompatibility(JointCompatibility::new(params.joint_compatibility)?)
            }
            _ => Rule::NearestNeighbour(NearestNeighbour::new(params.nearest_neighbour)?),
        };
        let [x, y, heading] = params.laser.unwrap_or_default();
        let sensor = OnDrifting(Mounted { sensor: params.sensor, mount: Pose2::new(x, y, heading) });
        let state = DriftingPose { pose: start, heading_drift: 0.0 };
        let drift_variance = params.heading_drift_sigma.powi(2);
        let covariance = Matrix4::from_diagonal(&Vector4::new(0.0, 0.0, 0.0, drift_variance));
        let extractor = Extractor::new(params.lines)?;
        Ok(Self {
            filter: EkfSlam::with_start_covariance(sensor, params.filter, state, covariance)?,
            extractor,
            association,
            params,
            moves_by_velocity,
            time: Stamp::default(),
            velocity: None,
            dead_reckoning: start,
            keyframes: Vec::new(),
            events: Events::default(),
            step: Duration::ZERO,
        })
    }

    /// Tells the robot of a wall whose place is known.
    pub(super) fn add_anchor(&mut self, id: LandmarkId, wall: Wall) -> Result<(), SlamError> {
        self.filter.add_anchor(id, wall)
    }
    /// The filter: robot, walls, covariance.
    pub fn filter(&self) -> &EkfSlam<WallModel> {
        &self.filter
    }
    /// One estimate for every scan.
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    fn take_increment(&mut self, stamp: Stamp, increment: &Pose2<f64>) -> Result<(), String> {
        let stopwatch = Stopwatch::start();
        self.filter
            .predict(&DriftingMotion(self.params.increment), increment)
            .map_err(|error| error.to_string())?;
        self.step += stopwatch.elapsed();
        self.dead_reckoning = self.dead_reckoning.compose(increment);
        self.time = stamp;
        Ok(())
    }

    /// Moves the robot on with the velocity that held.
    fn advance_to(&mut self, stamp: Stamp) -> Result<(), String> {
        let Some((since, velocity)) = self.velocity else { return Ok(()) };
        let seconds = stamp.seconds_since(since);
        self.velocity = Some((stamp, velocity));
        let twist = Vector3::new(velocity.linear * seconds, 0.0, velocity.angular * seconds);
        self.take_increment(stamp, &Pose2::exp(&twist))
    }

    fn take_scan(&mut self, stamp: Stamp, scan: &LaserScan) -> Result<(), String> {
        let stopwatch = Stopwatch::start();
        let observations = self.walls_in(scan)?;
        let report = match &mut self.association {
            Rule::NearestNeighbour(rule) => self.filter.update(&observations, rule),
            Rule::JointCompatibility(rule) => self.filter.update(&observations, rule),
        };
        self.step += stopwatch.elapsed();
        let report = report.map_err(|error| error.to_string())?;
        self.count(&report);
        self.keyframes.push(Keyframe {
            stamp,
            pose: self.filter.robot().pose,
            covariance: self.filter.robot_covariance().fixed_view::<3, 3>(0, 0).into_owned(),
            dead_reckoning: self.dead_reckoning,
            n_landmarks: self.filter.n_landmarks(),
            nis: report.innovations().fold((0.0, 0), |(sum, n), innovation| (sum + innovation.nis, n + 1)),
            step: std::mem::take(&mut self.step),
        });
        Ok(())
    }

    /// The walls of a scan that are long enough to be walls.
    fn walls_in(&mut self, scan: &LaserScan) -> Result<Vec<Observation<SeenWall>>, String> {
        let LaserScan { angle_min, angle_increment, range_max, ranges } = scan;
        let scan = Scan {
            angle_min: *angle_min,
            angle_increment: *angle_increment,
            ranges,
            max_range: range_max.next_down(), // a range of `range_max` is no echo
        };
        let found = self.extractor.extract(&scan).map_err(|error| error.to_string())?;
        let long = found.segments.iter().filter(|segment| segment.length() >= self.params.min_wall_length);
        Ok(long.map(|segment| Observation { label: None, measurement: SeenWall::from(segment) }).collect())
    }

    fn count(&mut self, report: &StepReport<SeenWall>) {
        for outcome in &report.outcomes {
            self.events.count(event_name(outcome));
        }
    }
}

impl System for WallSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        match &record.data {
            Data::OdometryIncrement(increment) => self.take_increment(record.stamp, increment),
            Data::Velocity(velocity) if self.moves_by_velocity => {
                self.advance_to(record.stamp)?;
                self.velocity = Some((record.stamp, *velocity));
                Ok(())
            }
            Data::Scan(scan) => {
                self.advance_to(record.stamp)?;
                self.take_scan(record.stamp, scan)
            }
            _ => Ok(()),
        }
    }
    fn events(&mut self) -> &mut Events {
        &mut self.events
    }
}
