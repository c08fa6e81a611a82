use std::collections::VecDeque;

use nalgebra::{Matrix3, Vector2};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2, wrap_angle};
use wayfix_evaluation::plot::ScanSample;
use wayfix_line_extract::LineExtractor;
use wayfix_scan_match::ScanMatcher;
use wayfix_sensor_log::{LaserScan, LogError, Record, RecordData, Stamp};
use wayfix_slam_ekf::{
    EkfSlam, ExternalParams, MountedSensor, PoseWithHeadingDrift, SensorWithHeadingDrift, WallSensor,
};
use wayfix_system_core::{
    EstimateWriter, EventCounts, IncrementPlausibilityCheck, Stopwatch, TurnHistory, check_velocity,
};

use super::{
    KeyframeThreshold, WallFrontEndState, WallSlamParams, drawing,
    match_to_keyframe::KeyframeMatch,
    odometry::{Motion, OdometryBetweenScans},
    odometry_scale::OdometryScale,
    plots::SearchBandScan,
    relative_motion::RelativeMotion,
    repeated_scan::RepeatedScanCheck,
    scan::{KeyframeScan, PlacedScan, WaitingScan, beam_step},
};
use crate::slam::{FrontEnd, MotionEstimate, SlamEstimator, SlamSystem, nis};

/// Walls seen by a laser that may sit anywhere on a robot whose odometry may drift.
pub type WallModel = SensorWithHeadingDrift<MountedSensor<WallSensor>>;

/// EKF-SLAM with walls.
pub type WallSystem = SlamSystem<WallSlamFrontEnd>;

/// Laser scans, matched to keyframes of which walls are extracted.
pub struct WallSlamFrontEnd {
    pub(super) params: WallSlamParams,
    pub(super) moves_by_velocity: bool,
    extractor: LineExtractor,
    pub(super) matcher: Option<ScanMatcher>,
    /// The last keyframe, which later scans are matched to.
    pub(super) last_keyframe: Option<KeyframeScan>,
    /// The motion since.
    pub(super) relative_motion: RelativeMotion,
    pub(super) odometry: OdometryBetweenScans,
    /// The present pose of the laser, if the log gives it and the parameters do not.
    pub(super) current_laser_mount: Option<Pose2<f64>>,
    /// Whether the log places the laser, and not the parameters.
    pub(super) laser_follows_log: bool,
    plausible: IncrementPlausibilityCheck,
    /// Scans that wait for the odometry that leads up to them, oldest first.
    pub(super) waiting: VecDeque<WaitingScan>,
    /// Heading by the points of the last scan alone, relative to the last keyframe, rad.
    laser_heading: Option<f64>,
    /// By how much the robot has turned to each scan from the one before, by odometry and by the scans alone.
    pub(super) turns: TurnHistory,
    repeated_scans: RepeatedScanCheck,
    /// Motions by the scans alone beside those by odometry.
    pub(super) odometry_scale: OdometryScale,
    dead_reckoning_at_keyframe: Option<Pose2<f64>>,
    /// Points for the picture of the map.
    pub(super) scan_sample: ScanSample,
    pub(super) search_bands: SearchBandScan,
}

impl WallSystem {
    /// A robot at `start` with an empty map; its motion is given by velocities or by increments.
    ///
    /// The covariance of the start is in its body frame, `(x, y, θ)`.
    ///
    /// # Errors
    /// When a parameter is out of range.
    pub(super) fn with_walls(
        params: WallSlamParams,
        start: Pose2<f64>,
        start_covariance: &Matrix3<f64>,
        moves_by_velocity: bool,
    ) -> anyhow::Result<Self> {
        let params = params.validated()?;
        let association = params.association.with(params.nearest_neighbour, params.joint_compatibility)?;
        let sensor = SensorWithHeadingDrift(MountedSensor { sensor: params.sensor, mount: params.mount() });
        let state = PoseWithHeadingDrift { pose: start, heading_drift: 0.0 };
        let mut covariance = start_covariance.to_homogeneous();
        covariance.m44 = params.heading_drift_sigma.powi(2);
        let filter = EkfSlam::with_start_covariance(sensor, params.filter, state, covariance)?;
        let estimator = SlamEstimator::new(filter, association, params.record_observability, start);
        let front_end = WallSlamFrontEnd {
            extractor: LineExtractor::new(params.line_extraction)?,
            matcher: params.match_scans.then(|| ScanMatcher::new(params.scan_match)).transpose()?,
            last_keyframe: None,
            relative_motion: RelativeMotion::default(),
            params,
            moves_by_velocity,
            odometry: OdometryBetweenScans::default(),
            current_laser_mount: None,
            laser_follows_log: false,
            plausible: IncrementPlausibilityCheck::default(),
            waiting: VecDeque::new(),
            laser_heading: None,
            turns: TurnHistory::default(),
            repeated_scans: RepeatedScanCheck::default(),
            odometry_scale: OdometryScale::default(),
            dead_reckoning_at_keyframe: None,
            scan_sample: ScanSample::default(),
            search_bands: SearchBandScan::default(),
        };
        Ok(Self::new(front_end, estimator))
    }
}

/// The estimator of this front end.
pub(super) type Walls = SlamEstimator<WallModel>;

impl FrontEnd for WallSlamFrontEnd {
    type Model = WallModel;
    type State = WallFrontEndState;

    fn take(&mut self, record: &Record, estimator: &mut Walls) -> Result<(), String> {
        match &record.data {
            RecordData::OdometryIncrement(increment) if !self.moves_by_velocity => {
                self.take_increment(record.stamp, increment, estimator)
            }
            RecordData::Velocity(velocity) if self.moves_by_velocity => {
                check_velocity(*velocity)?;
                self.advance_to(record.stamp, estimator);
                self.odometry.hold(record.stamp, *velocity)
            }
            RecordData::OdometryIncrement(_) | RecordData::Velocity(_) | RecordData::Ackermann(_) => {
                estimator.events.count("second_odometry_source_ignored");
                Ok(())
            }
            RecordData::Scan(scan) => self.take_or_wait(record.stamp, scan, estimator),
            RecordData::LaserMount(mount) if self.laser_follows_log => {
                self.current_laser_mount = Some(*mount);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// No odometry leads up to the scans that still wait.
    fn finish(&mut self, estimator: &mut Walls) -> Result<(), String> {
        while let Some(waiting) = self.waiting.pop_front() {
            if self.odometry.has_started() {
                let motion = self.odometry.unknown_until(waiting.stamp);
                self.move_by(&motion, estimator);
            } else {
                self.odometry.start(waiting.stamp);
            }
            self.take_waiting_scan(&waiting, estimator);
        }
        Ok(())
    }

    /// Scans that wait for their odometry come later.
    fn settled_until(&self, taken_until: Stamp) -> Stamp {
        let before =
            |waiting: &WaitingScan| Stamp::from_nanoseconds(waiting.stamp.nanoseconds().saturating_sub(1));
        self.waiting.front().map_or(taken_until, before)
    }

    fn external(&self) -> (&ExternalParams, Vector2<f64>) {
        (&self.params.external, self.params.antenna.into())
    }

    /// The filter stays at the last keyframe.
    fn motion_to(&mut self, stamp: Stamp, estimator: &mut Walls) -> Result<Option<MotionEstimate>, String> {
        if self.moves_by_velocity {
            self.advance_to(stamp, estimator);
        }
        let drift_variance = estimator.filter.robot_covariance().m44;
        let covariance = self.relative_motion.total_covariance(drift_variance);
        Ok(self.odometry.has_started().then_some((self.relative_motion.motion, covariance)))
    }

    /// The motion since the keyframe has the corrected drift taken out.
    fn corrected(&mut self, before: &PoseWithHeadingDrift, after: &PoseWithHeadingDrift) {
        let drift_change = after.heading_drift - before.heading_drift;
        self.relative_motion = self.relative_motion.with_drift_changed_by(drift_change);
    }

    fn draw_map(
        filter: &EkfSlam<WallModel>,
        stamp: Stamp,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        drawing::draw_map(filter, stamp, writer)
    }

    fn state(&self) -> WallFrontEndState {
        WallFrontEndState::of(self)
    }
}

impl WallSlamFrontEnd {
    /// Where the laser is on the robot.
    pub(super) fn mount(&self) -> Pose2<f64> {
        self.params.mount()
    }

    /// Takes the scans that waited for this increment, each after its part of it.
    fn take_increment(
        &mut self,
        stamp: Stamp,
        increment: &Pose2<f64>,
        estimator: &mut Walls,
    ) -> Result<(), String> {
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
            estimator.events.count("record_before_start");
            return Ok(());
        }
        let mut scans = reached.iter();
        for motion in &motions {
            self.move_by(motion, estimator);
            if let Some(waiting) = scans.next() {
                self.take_waiting_scan(waiting, estimator);
            }
        }
        Ok(())
    }

    fn move_by(&mut self, motion: &Motion, estimator: &mut Walls) {
        let Motion { increment, error, unknown_seconds } = motion;
        self.relative_motion = self
            .relative_motion
            .then(&self.params.increment_noise, estimator.filter.robot().heading_drift, increment)
            .with_added_covariance(error);
        estimator.move_dead_reckoning(increment);
        if *unknown_seconds > self.params.velocity_timeout {
            estimator.events.warn(
                "motion_unknown",
                "odometry is missing for some time: the motion there comes from scan matching alone",
            );
        }
    }

    /// Moves the robot on with the velocity that holds.
    fn advance_to(&mut self, stamp: Stamp, estimator: &mut Walls) {
        if let Some(motion) = self.odometry.held_until(stamp, self.params.velocity_timeout)
            && self.odometry.has_started()
        {
            self.move_by(&motion, estimator);
        }
    }

    /// Takes a scan now, when odometry leads up to it or never will, else with the next increment.
    fn take_or_wait(&mut self, stamp: Stamp, scan: &LaserScan, estimator: &mut Walls) -> Result<(), String> {
        let laser = self.current_laser_mount.unwrap_or(self.mount());
        if self.moves_by_velocity {
            self.advance_to(stamp, estimator);
        } else if !(self.waiting.is_empty() && self.odometry.reaches(stamp)) || self.needs_twist(scan) {
            self.waiting.push_back(WaitingScan { stamp, scan: scan.clone(), laser });
            return Ok(());
        }
        if !self.odometry.has_started() {
            self.odometry.start(stamp);
        }
        self.take_scan(stamp, scan, &laser, estimator)
    }

    /// Whether the scan must be deskewed and no odometry has given a velocity yet.
    fn needs_twist(&self, scan: &LaserScan) -> bool {
        self.params.deskew_scans && scan.beam_period > 0.0 && self.odometry.twist().is_none()
    }

    /// Takes a scan that waited.
    fn take_waiting_scan(&mut self, WaitingScan { stamp, scan, laser }: &WaitingScan, estimator: &mut Walls) {
        if let Err(reason) = self.take_scan(*stamp, scan, laser, estimator) {
            estimator.events.refuse("record_refused", format!("scan of {stamp}: {reason}"));
        }
    }

    fn take_scan(
        &mut self,
        stamp: Stamp,
        scan: &LaserScan,
        laser: &Pose2<f64>,
        estimator: &mut Walls,
    ) -> Result<(), String> {
        let stopwatch = Stopwatch::start();
        if let Err(reason) = self.repeated_scans.check(scan, &estimator.dead_reckoning) {
            self.add_stamped_estimate(stamp, (0.0, 0), estimator);
            return Err(reason);
        }
        if scan.echoes().next().is_none() {
            estimator.events.count("scan_without_echo");
        }
        let scan = self.placed(scan, laser, &mut estimator.events);
        let cloud = scan.cloud().map_err(|error| error.to_string())?;
        let matched = self.match_to_keyframe(&cloud, estimator);
        let laser_heading = matched.and_then(|matched| matched.heading());
        let seen_turn = self.laser_heading.zip(laser_heading).map(|(from, to)| wrap_angle(to - from));
        self.laser_heading = laser_heading;
        let KeyframeThreshold { min_distance, min_rotation } = self.params.keyframes;
        let is_near = self.relative_motion.is_within(min_distance, min_rotation);
        let nis_of_walls = if self.last_keyframe.is_some() && is_near {
            estimator.events.count("scan_skipped");
            (0.0, 0)
        } else {
            self.take_keyframe(KeyframeScan { scan, cloud }, matched, estimator)?
        };
        estimator.step += stopwatch.elapsed();
        self.add_stamped_estimate(stamp, nis_of_walls, estimator);
        self.turns.push(stamp, estimator.dead_reckoning, seen_turn);
        Ok(())
    }

    /// Moves the filter to a scan and corrects it by the walls of the scan, which is the last keyframe then. Returns sum and number of the NIS.
    fn take_keyframe(
        &mut self,
        keyframe: KeyframeScan,
        matched: Option<KeyframeMatch>,
        estimator: &mut Walls,
    ) -> Result<(f64, usize), String> {
        let found = keyframe.scan.walls(&mut self.extractor).map_err(|error| error.to_string())?;
        self.compare_with_odometry(matched, &estimator.dead_reckoning);
        self.predict_to_scan(estimator)?;
        let observations =
            self.walls_among(&found.segments, (&keyframe.scan.laser, &keyframe.cloud), estimator);
        let keyframe = self.last_keyframe.insert(keyframe);
        self.dead_reckoning_at_keyframe = Some(estimator.dead_reckoning);
        self.laser_heading = Some(0.0);
        let report = estimator.update(&observations, |wall| {
            format!("a wall with the ends {:?}, {:?}, m", wall.ends[0].as_slice(), wall.ends[1].as_slice())
        })?;
        self.scan_sample.offer(keyframe.cloud.points(), &estimator.filter.robot().pose);
        Ok(nis(&report))
    }

    /// Compares the motion from the last keyframe to a new one by odometry and by the scans alone.
    fn compare_with_odometry(&mut self, matched: Option<KeyframeMatch>, dead_reckoning: &Pose2<f64>) {
        if let (Some(from), Some(KeyframeMatch { guess, found })) = (self.dead_reckoning_at_keyframe, matched)
        {
            let odometry = from.inverse().compose(dead_reckoning);
            let noise = self.params.increment_noise.noise(&from, &odometry);
            self.odometry_scale.add(&odometry, &noise, &guess, &found);
        }
    }

    /// A scan with the motion of the laser during it, by the velocity of odometry.
    fn placed(&self, scan: &LaserScan, laser: &Pose2<f64>, events: &mut EventCounts) -> PlacedScan {
        let twist = self.odometry.twist().filter(|_| self.params.deskew_scans);
        let step = twist.map_or(Ok(None), |twist| beam_step(scan, laser, &twist));
        if step.is_err() {
            events.warn(
                "scan_duration_implausible",
                "by its time_increment a scan takes longer than a second: its beams are taken as sent at once",
            );
        } else if let Ok(Some(_)) = &step {
            events.count("scan_deskewed");
        }
        let distance = laser.translation.norm();
        if distance > scan.range_max {
            let far = format!(
                "the laser is mounted {distance:.1} m from the robot's centre, farther than it sees: check the units of its transform or of `laser_pose`"
            );
            events.warn("laser_mount_implausible", far);
        }
        PlacedScan { scan: scan.clone(), laser: *laser, beam_step: step.unwrap_or(None) }
    }

    /// Moves the robot by the motion since the last keyframe.
    fn predict_to_scan(&mut self, estimator: &mut Walls) -> Result<(), String> {
        let relative_motion = self.relative_motion;
        estimator.predict(&relative_motion, &relative_motion.motion)?;
        self.relative_motion = relative_motion.reset_at_keyframe();
        Ok(())
    }

    /// The filter is at the last keyframe; the estimate is at the scan.
    fn add_stamped_estimate(&self, stamp: Stamp, nis: (f64, usize), estimator: &mut Walls) {
        let (state, covariance) = estimator.predicted(&self.relative_motion, &self.relative_motion.motion);
        let covariance = covariance.fixed_view::<3, 3>(0, 0).into_owned();
        estimator.add_stamped_estimate(stamp, state.pose, covariance, nis);
    }
}
