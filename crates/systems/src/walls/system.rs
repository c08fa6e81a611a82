use std::{collections::VecDeque, time::Duration};

use nalgebra::Matrix3;
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2, wrap_angle};
use wayfix_line_extract::Extractor;
use wayfix_scan_match::Matcher;
use wayfix_sensor_log::{Data, LaserScan, Record, Stamp};
use wayfix_slam_ekf::{
    DriftingPose, DriftingPoseSensor, EkfSlam, JointCompatibility, LandmarkId, MountedSensor,
    NearestNeighbour, Observation, SlamError, StepReport, Wall, WallMeasurement, WallSensor,
    observability::ObservabilityRecorder,
};

use super::{
    KeyframeThreshold, WallSlamParams,
    odometry::{Motion, Odometry},
    relative_motion::RelativeMotion,
    scan::{KeyframeScan, PlacedScan, WaitingScan, beam_step},
};
use crate::{
    slam::{AssociationRule, StampedEstimate, event_name, seen_landmarks},
    system::{Events, PlausibleIncrement, Stopwatch, System, check_velocity},
};

/// Walls seen by a laser that may sit anywhere on a robot whose odometry may drift.
pub type WallModel = DriftingPoseSensor<MountedSensor<WallSensor>>;

/// EKF-SLAM that takes scans and keeps a map of walls.
pub struct WallSystem {
    pub(super) params: WallSlamParams,
    pub(super) moves_by_velocity: bool,
    extractor: Extractor,
    pub(super) matcher: Option<Matcher>,
    /// The scan that was looked at last, which those after it are laid on.
    pub(super) last_keyframe: Option<KeyframeScan>,
    /// The way since.
    pub(super) relative_motion: RelativeMotion,
    pub(super) filter: EkfSlam<WallModel>,
    pub(super) association: Rule,
    /// Stamp of the last record that was taken.
    pub(super) taken_until: Stamp,
    /// Records up to this stamp were taken by the run that this one goes on from.
    pub(super) resumed_at: Option<Stamp>,
    pub(super) odometry: Odometry,
    /// Where the laser is now, where the log says it and the parameters do not.
    pub(super) current_laser_mount: Option<Pose2<f64>>,
    /// Whether the log places the laser, and not the parameters.
    pub(super) laser_follows_log: bool,
    plausible: PlausibleIncrement,
    /// Scans that wait for the odometry that leads up to them, oldest first.
    pub(super) waiting: VecDeque<WaitingScan>,
    pub(super) dead_reckoning: Pose2<f64>,
    pub(super) observability: Option<ObservabilityRecorder>,
    stamped_estimates: Vec<StampedEstimate>,
    /// Heading by the points of the last scan alone, seen from the last look, rad.
    laser_heading: Option<f64>,
    /// By how much the robot has turned to each estimate from the one before, by the scans alone, rad.
    seen_turns: Vec<Option<f64>>,
    pub(super) events: Events,
    step: Duration,
}

pub(super) enum Rule {
    NearestNeighbour(NearestNeighbour),
    JointCompatibility(JointCompatibility),
}

impl WallSystem {
    /// A robot at `start` with an empty map; its motion is given by velocities or by increments.
    ///
    /// The covariance of the start is in its body frame, `(x, y, θ)`.
    ///
    /// # Errors
    /// When a parameter is out of range.
    pub(super) fn new(
        params: WallSlamParams,
        start: Pose2<f64>,
        start_covariance: &Matrix3<f64>,
        moves_by_velocity: bool,
    ) -> anyhow::Result<Self> {
        let params = params.validated()?;
        let association = match params.association {
            AssociationRule::Jcbb => {
                Rule::JointCompatibility(JointCompatibility::new(params.joint_compatibility)?)
            }
            _ => Rule::NearestNeighbour(NearestNeighbour::new(params.nearest_neighbour)?),
        };
        let sensor = DriftingPoseSensor(MountedSensor { sensor: params.sensor, mount: params.mount() });
        let state = DriftingPose { pose: start, heading_drift: 0.0 };
        let mut covariance = start_covariance.to_homogeneous();
        covariance.m44 = params.heading_drift_sigma.powi(2);
        let filter = EkfSlam::with_start_covariance(sensor, params.filter, state, covariance)?;
        Ok(Self {
            extractor: Extractor::new(params.lines)?,
            matcher: params.match_scans.then(|| Matcher::new(params.scan_match)).transpose()?,
            last_keyframe: None,
            relative_motion: RelativeMotion::default(),
            observability: params.record_observability.then(|| ObservabilityRecorder::new(&filter)),
            filter,
            association,
            params,
            moves_by_velocity,
            taken_until: Stamp::default(),
            resumed_at: None,
            odometry: Odometry::default(),
            current_laser_mount: None,
            laser_follows_log: false,
            plausible: PlausibleIncrement::default(),
            waiting: VecDeque::new(),
            dead_reckoning: start,
            stamped_estimates: Vec::new(),
            laser_heading: None,
            seen_turns: Vec::new(),
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
    pub fn stamped_estimates(&self) -> &[StampedEstimate] {
        &self.stamped_estimates
    }
    /// By how much the robot has turned to each estimate from the one before, by the scans alone, where they tell.
    pub(super) fn seen_turns(&self) -> &[Option<f64>] {
        &self.seen_turns
    }
    /// Where the laser sits on the robot.
    pub(super) fn mount(&self) -> Pose2<f64> {
        self.params.mount()
    }
    /// What the run observed, when that was to be recorded.
    pub fn observability(&self) -> Option<&ObservabilityRecorder> {
        self.observability.as_ref()
    }

    /// Takes the scans that waited for this increment, each after its part of it.
    fn take_increment(&mut self, stamp: Stamp, increment: &Pose2<f64>) -> Result<(), String> {
        self.plausible.check(stamp, increment)?;
        let n_reached = self.waiting.partition_point(|waiting| waiting.stamp <= stamp);
        let reached: Vec<WaitingScan> = self.waiting.drain(..n_reached).collect();
        if let (Some(first), false) = (reached.first(), self.odometry.has_started()) {
            self.odometry.start(first.stamp);
        }
        let has_started = self.odometry.has_started();
        let cuts: Vec<Stamp> = reached.iter().map(|waiting| waiting.stamp).collect();
        let motions = self.odometry.cut(increment, stamp, &cuts);
        if !has_started {
            self.events.count("before_start");
            return Ok(());
        }
        let mut scans = reached.iter();
        for motion in &motions {
            self.move_by(motion);
            if let Some(waiting) = scans.next() {
                self.take_waiting_scan(waiting);
            }
        }
        Ok(())
    }

    fn move_by(&mut self, motion: &Motion) {
        let Motion { increment, error, unknown_seconds } = motion;
        self.relative_motion = self
            .relative_motion
            .then(&self.params.increment, self.filter.robot().heading_drift, increment)
            .with_added_covariance(error);
        self.dead_reckoning = self.dead_reckoning.compose(increment);
        if *unknown_seconds > self.params.velocity_hold {
            self.events.warn(
                "motion_unknown",
                "odometry is missing for some time: the motion there comes from scan matching alone",
            );
        }
    }

    /// Moves the robot on with the velocity that holds.
    fn advance_to(&mut self, stamp: Stamp) {
        if let Some(motion) = self.odometry.held_until(stamp, self.params.velocity_hold)
            && self.odometry.has_started()
        {
            self.move_by(&motion);
        }
    }

    /// Takes a scan now, when odometry leads up to it or never will, else with the next increment.
    fn take_or_wait(&mut self, stamp: Stamp, scan: &LaserScan) -> Result<(), String> {
        let laser = self.current_laser_mount.unwrap_or(self.mount());
        if self.moves_by_velocity {
            self.advance_to(stamp);
        } else if !(self.waiting.is_empty() && self.odometry.reaches(stamp)) || self.needs_twist(scan) {
            self.waiting.push_back(WaitingScan { stamp, scan: scan.clone(), laser });
            return Ok(());
        }
        if !self.odometry.has_started() {
            self.odometry.start(stamp);
        }
        self.take_scan(stamp, scan, &laser)
    }

    /// Whether the motion during a scan is to be taken out and no odometry has told any yet.
    fn needs_twist(&self, scan: &LaserScan) -> bool {
        self.params.deskew_scans && scan.beam_period > 0.0 && self.odometry.twist().is_none()
    }

    /// Takes a scan that waited.
    fn take_waiting_scan(&mut self, WaitingScan { stamp, scan, laser }: &WaitingScan) {
        if let Err(reason) = self.take_scan(*stamp, scan, laser) {
            self.events.refuse("record_refused", format!("scan of {stamp}: {reason}"));
        }
    }

    fn take_scan(&mut self, stamp: Stamp, scan: &LaserScan, laser: &Pose2<f64>) -> Result<(), String> {
        let stopwatch = Stopwatch::start();
        let scan = self.placed(scan, laser);
        let cloud = scan.cloud().map_err(|error| error.to_string())?;
        let laser_heading = self.match_to_keyframe(&cloud);
        let seen_turn = self.laser_heading.zip(laser_heading).map(|(from, to)| wrap_angle(to - from));
        self.laser_heading = laser_heading;
        let KeyframeThreshold { min_distance, min_rotation } = self.params.keyframes;
        let nis =
            if self.last_keyframe.is_some() && self.relative_motion.is_within(min_distance, min_rotation) {
                self.events.count("scan_skipped");
                (0.0, 0)
            } else {
                let observations = self.walls_in(&scan)?;
                self.predict_to_scan()?;
                self.last_keyframe = Some(KeyframeScan { scan, cloud });
                self.laser_heading = Some(0.0);
                self.update_with_walls(&observations)?
            };
        self.step += stopwatch.elapsed();
        self.add_stamped_estimate(stamp, nis);
        self.seen_turns.push(seen_turn);
        Ok(())
    }

    /// A scan with the motion of the laser while it was taken, by the velocity that odometry tells.
    fn placed(&mut self, scan: &LaserScan, laser: &Pose2<f64>) -> PlacedScan {
        let twist = self.odometry.twist().filter(|_| self.params.deskew_scans);
        let step = twist.map_or(Ok(None), |twist| beam_step(scan, laser, &twist));
        if step.is_err() {
            self.events.warn(
                "time_increment_implausible",
                "by its time_increment a scan takes longer than a second: its beams are taken as sent at once",
            );
        } else if let Ok(Some(_)) = &step {
            self.events.count("scan_deskewed");
        }
        PlacedScan { scan: scan.clone(), laser: *laser, beam_step: step.unwrap_or(None) }
    }

    /// Moves the robot on by the way since the last look.
    fn predict_to_scan(&mut self) -> Result<(), String> {
        let relative_motion = self.relative_motion;
        let jacobian = relative_motion.jacobian(self.filter.robot(), &relative_motion.motion);
        self.filter.predict(&relative_motion, &relative_motion.motion).map_err(|error| error.to_string())?;
        self.relative_motion = relative_motion.reset_at_keyframe();
        if let Some(recorder) = &mut self.observability {
            recorder.record_motion(&jacobian);
        }
        Ok(())
    }

    /// Corrects robot and map with the walls of a scan; sum and number of the NIS of what corrected.
    fn update_with_walls(
        &mut self,
        observations: &[Observation<WallMeasurement>],
    ) -> Result<(f64, usize), String> {
        let report = match &mut self.association {
            Rule::NearestNeighbour(rule) => self.filter.update(observations, rule),
            Rule::JointCompatibility(rule) => self.filter.update(observations, rule),
        };
        let report = report.map_err(|error| error.to_string())?;
        if let Some(recorder) = &mut self.observability {
            recorder.record(&self.filter, &seen_landmarks(&report));
        }
        self.count(&report);
        Ok(report.innovations().fold((0.0, 0), |(sum, n), innovation| (sum + innovation.nis, n + 1)))
    }

    /// The filter is at the last scan that was looked at; the estimate says where the robot is by now.
    fn add_stamped_estimate(&mut self, stamp: Stamp, nis: (f64, usize)) {
        let (state, relative_motion) = (self.filter.robot(), &self.relative_motion);
        let jacobian = relative_motion.jacobian(state, &relative_motion.motion);
        let covariance = jacobian * self.filter.robot_covariance() * jacobian.transpose()
            + relative_motion.noise(state, &relative_motion.motion);
        self.stamped_estimates.push(StampedEstimate {
            stamp,
            pose: relative_motion.propagate(state, &relative_motion.motion).pose,
            covariance: covariance.fixed_view::<3, 3>(0, 0).into_owned(),
            dead_reckoning: self.dead_reckoning,
            n_landmarks: self.filter.n_landmarks(),
            nis,
            step: std::mem::take(&mut self.step),
        });
    }

    /// The walls of a scan that are long enough to be walls, as the laser would see them from where the model has it.
    fn walls_in(&mut self, scan: &PlacedScan) -> Result<Vec<Observation<WallMeasurement>>, String> {
        let found = scan.walls(&mut self.extractor).map_err(|error| error.to_string())?;
        let long = found.segments.iter().filter(|segment| segment.length() >= self.params.min_wall_length);
        let seen = long.map(WallMeasurement::from);
        let moved = self.mount().inverse().compose(&scan.laser);
        let as_seen =
            |seen: WallMeasurement| if scan.laser == self.mount() { seen } else { seen.transformed(&moved) };
        Ok(seen.map(|seen| Observation { label: None, measurement: as_seen(seen) }).collect())
    }

    fn count(&mut self, report: &StepReport<WallMeasurement>) {
        for outcome in &report.outcomes {
            self.events.count(event_name(outcome));
        }
    }
}

impl System for WallSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        if self.resumed_at.is_some_and(|resumed_at| record.stamp <= resumed_at) {
            self.events.count("before_resume");
            return Ok(());
        }
        self.taken_until = record.stamp;
        match &record.data {
            Data::OdometryIncrement(increment) => self.take_increment(record.stamp, increment),
            Data::Velocity(velocity) if self.moves_by_velocity => {
                check_velocity(*velocity)?;
                self.advance_to(record.stamp);
                self.odometry.hold(record.stamp, *velocity)
            }
            Data::Scan(scan) => self.take_or_wait(record.stamp, scan),
            Data::LaserMount(mount) if self.laser_follows_log => {
                self.current_laser_mount = Some(*mount);
                Ok(())
            }
            _ => Ok(()),
        }
    }
    /// No odometry leads up to the scans that still wait.
    fn finish(&mut self) -> Result<(), String> {
        while let Some(waiting) = self.waiting.pop_front() {
            if self.odometry.has_started() {
                let motion = self.odometry.unknown_until(waiting.stamp);
                self.move_by(&motion);
            } else {
                self.odometry.start(waiting.stamp);
            }
            self.take_waiting_scan(&waiting);
        }
        Ok(())
    }
    fn events(&mut self) -> &mut Events {
        &mut self.events
    }
}
