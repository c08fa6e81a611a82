use nalgebra::{Matrix3, Vector2};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};
use wayfix_sensor_log::{
    AckermannDrive, Detection, DetectionTarget, LogError, Record, RecordData, Stamp, Velocity,
};
use wayfix_slam_ekf::MotionStatistics;
use wayfix_slam_ekf::{
    EkfSlam, ExternalParams, LandmarkId, MotionWithRangeScale, MountedSensor, Observation,
    PoseWithRangeScale, RangeBearing, RangeBearingSensor, RangeBearingSensorWithScale, SequentialMotion,
    SlamError, SlamParams, SlamSnapshot, UnknownMotion,
};
use wayfix_system_core::{
    EstimateWriter, IncrementPlausibilityCheck, OdometryRecordKind, Stopwatch, check_velocity,
};

use super::{
    MountingParams, PointSlamParams, commands::Commands, drawing, follower::PointFollower,
    state::PointFrontEndState,
};
use crate::slam::{AssociationRule, FrontEnd, MotionEstimate, SavedMapError, SlamEstimator, SlamSystem, nis};

/// Points seen by a range-bearing sensor that may sit anywhere on the robot and whose scale is estimated.
pub type PointSensor = RangeBearingSensorWithScale<MountedSensor<RangeBearingSensor>>;

/// EKF-SLAM with points.
pub type PointSystem = SlamSystem<PointSlamFrontEnd>;

/// Detections of points with odometry that may come late.
pub struct PointSlamFrontEnd {
    pub(super) params: PointSlamParams,
    pub(super) commands: Commands,
    /// How the robot has moved by its commands.
    pub(super) motion: MotionStatistics,
    plausible: IncrementPlausibilityCheck,
    /// The kind of odometry that came first.
    pub(super) odometry: Option<OdometryRecordKind>,
    /// The time of the filter's state.
    pub(super) time: Stamp,
}

impl PointSystem {
    /// A robot at `start` in an empty map, from `start_stamp` on; the covariance of the start is in its body frame, `(x, y, θ)`.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub(super) fn with_points(
        params: PointSlamParams,
        rule: AssociationRule,
        start_stamp: Stamp,
        start: Pose2<f64>,
        start_covariance: &Matrix3<f64>,
    ) -> Result<Self, SlamError> {
        let params = params.validated()?;
        let association = rule.with(params.nearest_neighbour, params.joint_compatibility)?;
        // Two identities are two landmarks, however near they stand.
        let (confirmation, merging) = match rule {
            AssociationRule::Known => (params.filter.confirmation, None),
            AssociationRule::Nn | AssociationRule::Jcbb => {
                (params.unlabelled_confirmation, params.filter.merging)
            }
        };
        let filter_params = SlamParams { confirmation, merging, ..params.filter };
        let MountingParams { sensor_x, sensor_y, sensor_heading, .. } = params.mounting;
        let mount = Pose2::new(sensor_x, sensor_y, sensor_heading);
        let sensor = RangeBearingSensorWithScale(MountedSensor { sensor: params.sensor, mount });
        let state = PoseWithRangeScale { pose: start, log_range_scale: 0.0 };
        let mut covariance = start_covariance.to_homogeneous();
        covariance.m44 = params.robot.range_scale_sigma.powi(2);
        let filter = EkfSlam::with_start_covariance(sensor, filter_params, state, covariance)?;
        let estimator = SlamEstimator::new(filter, association, params.record_observability, start);
        let front_end = PointSlamFrontEnd {
            commands: Commands::new(&params.robot),
            motion: MotionStatistics::default(),
            plausible: IncrementPlausibilityCheck::default(),
            odometry: None,
            params,
            time: start_stamp,
        };
        Ok(Self::new(front_end, estimator))
    }

    /// Lets a smoother follow, if the parameters ask for one: from what an earlier one has saved, else from the state of the filter.
    pub(super) fn follow(&mut self, saved: Option<SavedPoints>) -> Result<(), SavedMapError> {
        let filter = &self.estimator.filter;
        let resume = |saved| EkfSlam::resume(*filter.model(), *filter.params(), saved);
        let saved = saved.map(resume).transpose()?;
        let start = saved.as_ref().unwrap_or(filter);
        let rule = self.association();
        self.estimator.follower = PointFollower::wanted(&self.front_end.params, rule, start)?;
        Ok(())
    }

    /// Where the antenna is when the robot is at `pose`.
    pub fn antenna(&self, pose: &Pose2<f64>) -> Vector2<f64> {
        pose.transform(&self.front_end.external().1)
    }
}

type Points = SlamEstimator<PointSensor>;
type SavedPoints = SlamSnapshot<PoseWithRangeScale, Vector2<f64>>;

impl FrontEnd for PointSlamFrontEnd {
    type Model = PointSensor;
    type State = PointFrontEndState;

    fn take(&mut self, record: &Record, estimator: &mut Points) -> Result<(), String> {
        let stamp = record.stamp;
        match &record.data {
            odometry if OdometryRecordKind::of(odometry).is_some_and(|kind| !self.moves_by(kind)) => {
                estimator.events.count("second_odometry_source_ignored");
                Ok(())
            }
            RecordData::Velocity(velocity) => self.take_velocity(stamp, *velocity, estimator),
            RecordData::Ackermann(drive) => self.take_drive(stamp, *drive, estimator),
            RecordData::OdometryIncrement(increment) => self.take_increment(stamp, increment, estimator),
            RecordData::Detections(detections) => self.take_detections(stamp, detections, estimator),
            _ => Ok(()),
        }
    }

    fn external(&self) -> (&ExternalParams, Vector2<f64>) {
        let MountingParams { antenna_x, antenna_y, .. } = self.params.mounting;
        (&self.params.external, Vector2::new(antenna_x, antenna_y))
    }

    /// The filter makes the whole motion.
    fn motion_to(&mut self, stamp: Stamp, estimator: &mut Points) -> Result<Option<MotionEstimate>, String> {
        let has_started = stamp >= self.time;
        self.advance_to(stamp, estimator)?;
        Ok(has_started.then(|| (Pose2::identity(), Matrix3::zeros())))
    }

    fn draw_map(
        filter: &EkfSlam<PointSensor>,
        stamp: Stamp,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        drawing::draw_map(filter, stamp, writer)
    }

    fn state(&self) -> PointFrontEndState {
        PointFrontEndState::of(self)
    }
}

impl PointSlamFrontEnd {
    fn take_velocity(
        &mut self,
        stamp: Stamp,
        velocity: Velocity,
        estimator: &mut Points,
    ) -> Result<(), String> {
        self.commands.push(stamp, check_velocity(velocity)?);
        self.advance_to(self.exposure(stamp), estimator)
    }

    /// The encoder and the steering of a car are the velocity of its rear axle.
    fn take_drive(
        &mut self,
        stamp: Stamp,
        drive: AckermannDrive,
        estimator: &mut Points,
    ) -> Result<(), String> {
        let moved = self.params.vehicle.velocity(drive.wheel_speed, drive.steering, 0.0);
        self.take_velocity(stamp, Velocity { linear: moved.linear, angular: moved.angular }, estimator)
    }

    fn take_increment(
        &mut self,
        stamp: Stamp,
        increment: &Pose2<f64>,
        estimator: &mut Points,
    ) -> Result<(), String> {
        self.plausible.check(stamp, increment)?;
        let stopwatch = Stopwatch::start();
        estimator.predict(&MotionWithRangeScale(self.params.increment_noise), increment)?;
        estimator.step += stopwatch.elapsed();
        estimator.move_dead_reckoning(increment);
        self.time = stamp;
        Ok(())
    }

    fn take_detections(
        &mut self,
        stamp: Stamp,
        detections: &[Detection],
        estimator: &mut Points,
    ) -> Result<(), String> {
        if stamp < self.time {
            estimator.events.count("record_before_start");
            return Ok(());
        }
        let observations = self.observations(detections, estimator);
        if observations.is_empty() && !detections.is_empty() {
            return Ok(()); // a scan of other robots only has no information about landmarks
        }
        self.advance_to(self.exposure(stamp), estimator)?;
        let stopwatch = Stopwatch::start();
        let report = estimator.update(&observations, |RangeBearing { range, bearing }| {
            format!("a range of {range} m at {} rad", bearing.radians())
        })?;
        estimator.step += stopwatch.elapsed();
        // The filter is at the exposure of the sensor; the estimate is at its stamp.
        let motion = MotionWithRangeScale(SequentialMotion(self.params.velocity_noise));
        let (state, covariance) =
            estimator.predicted(&motion, self.commands.between(self.time, stamp).as_slice());
        let covariance = covariance.fixed_view::<3, 3>(0, 0).into_owned();
        estimator.add_stamped_estimate(stamp, state.pose, covariance, nis(&report));
        Ok(())
    }

    /// Whether this kind of odometry moves the robot: the kind that comes first does. A log may record one motion in two kinds.
    fn moves_by(&mut self, odometry: OdometryRecordKind) -> bool {
        *self.odometry.get_or_insert(odometry) == odometry
    }

    /// The time at which the sensor saw what has this stamp.
    fn exposure(&self, stamp: Stamp) -> Stamp {
        let latency = (self.params.robot.sensor_latency * 1e9) as u64;
        Stamp::from_nanoseconds(stamp.nanoseconds().saturating_sub(latency))
    }

    /// Moves the robot by its commands; by all of them or none.
    fn advance_to(&mut self, time: Stamp, estimator: &mut Points) -> Result<(), String> {
        if time <= self.time {
            return Ok(());
        }
        let stopwatch = Stopwatch::start();
        let controls = self.commands.between(self.time, time);
        let motion = SequentialMotion(self.params.velocity_noise);
        estimator.predict(&MotionWithRangeScale(motion), controls.as_slice())?;
        estimator.dead_reckoning = motion.propagate(&estimator.dead_reckoning, &controls);
        for control in &self.commands.known_between(self.time, time) {
            let moved = self.params.velocity_noise.propagate(&Pose2::identity(), control);
            self.motion.add(&moved, control.duration);
        }
        self.predict_unknown_motion(self.commands.unknown_seconds(self.time, time), estimator)?;
        estimator.step += stopwatch.elapsed();
        self.commands.forget_before(time);
        self.time = time;
        Ok(())
    }

    /// Without a record of its motion, the robot may have moved at its usual speed.
    fn predict_unknown_motion(&mut self, seconds: f64, estimator: &mut Points) -> Result<(), String> {
        if seconds <= 0.0 {
            return Ok(());
        }
        let hold = self.params.robot.velocity_timeout;
        estimator.events.warn(
            "motion_unknown",
            format!("velocities are missing for more than {hold} s: the motion is unknown there (robot.velocity_timeout)"),
        );
        let unknown = MotionWithRangeScale(UnknownMotion(self.motion.unknown_motion(seconds)));
        estimator.predict_unrecorded(&unknown, &())
    }

    /// The detections that can be landmarks; the others are counted.
    fn observations(
        &self,
        detections: &[Detection],
        estimator: &mut Points,
    ) -> Vec<Observation<RangeBearing>> {
        let mut observations = Vec::with_capacity(detections.len());
        for detection in detections {
            let label = match detection.target {
                DetectionTarget::Landmark(id) => Some(LandmarkId(id)),
                DetectionTarget::Unlabelled => None,
                DetectionTarget::Robot(_) => {
                    estimator.events.count("robot_detection_ignored");
                    continue;
                }
                DetectionTarget::UnknownCode(_) => {
                    estimator.events.count("unknown_landmark_code");
                    continue;
                }
            };
            let depth_factor = if self.params.robot.range_is_depth { detection.bearing.cos() } else { 1.0 };
            let measurement = RangeBearing::new(detection.range / depth_factor, detection.bearing);
            observations.push(Observation { label, measurement });
        }
        observations
    }
}
