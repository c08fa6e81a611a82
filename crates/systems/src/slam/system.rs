use std::time::Duration;

use nalgebra::{DefaultAllocator, Matrix3, Vector2, allocator::Allocator};
use wayfix_estimation_traits::{LieGroup, Manifold, MotionModel, Pose2};
use wayfix_sensor_log::{AckermannDrive, Data, Detection, Record, Stamp, Target, Velocity};
use wayfix_slam_ekf::{
    EkfSlam, JointCompatibility, KnownIds, LandmarkId, MountedSensor, NearestNeighbour, Observation, Outcome,
    RangeBearing, RangeBearingSensor, ScaledMotion, ScaledPose, ScaledRangeBearingSensor, SlamError,
    SlamParams, StepReport, observability::ObservabilityRecorder,
};

use super::{
    AssociationRule, MountingParams, SlamSystemParams, commands::Commands, event_name, saved::Odometry,
    sequential_motion::SequentialMotion, unknown_motion::UnknownMotion,
};
use crate::system::{Events, MotionStatistics, PlausibleIncrement, Stopwatch, System, check_velocity};

/// The estimate at the stamp of one scan of the sensor, from all records up to it.
#[derive(Clone, Copy, Debug)]
pub struct StampedEstimate {
    /// When.
    pub stamp: Stamp,
    /// Estimated pose.
    pub pose: Pose2<f64>,
    /// Its covariance in the body frame.
    pub covariance: Matrix3<f64>,
    /// Where odometry alone would put the robot.
    pub dead_reckoning: Pose2<f64>,
    /// Landmarks in the map.
    pub n_landmarks: usize,
    /// Sum and number of the NIS of what corrected.
    pub nis: (f64, usize),
    /// Computing time since the last estimate.
    pub step: Duration,
}

/// Points seen by a range-bearing sensor that may sit anywhere on the robot and whose scale is estimated.
pub type PointSensor = ScaledRangeBearingSensor<MountedSensor<RangeBearingSensor>>;

/// EKF-SLAM that takes records.
pub struct SlamSystem {
    pub(super) params: SlamSystemParams,
    pub(super) filter: EkfSlam<PointSensor>,
    pub(super) association: Rule,
    pub(super) commands: Commands,
    /// How the robot has moved by its commands.
    pub(super) motion: MotionStatistics,
    plausible: PlausibleIncrement,
    /// Velocities or increments: whichever came first.
    pub(super) odometry: Option<Odometry>,
    /// The time that the filter's state is at.
    pub(super) time: Stamp,
    pub(super) past: Past,
    observability: Option<ObservabilityRecorder>,
    pub(super) dead_reckoning: Pose2<f64>,
    stamped_estimates: Vec<StampedEstimate>,
    events: Events,
    step: Duration,
}

/// Which records were taken, in this run and in the one that it goes on from.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Past {
    /// Stamp of the last record that was taken.
    pub(super) taken_until: Stamp,
    /// Records up to this stamp were taken by the run before.
    pub(super) resumed_at: Option<Stamp>,
}

pub(super) enum Rule {
    Known(KnownIds),
    NearestNeighbour(NearestNeighbour),
    JointCompatibility(JointCompatibility),
}

impl SlamSystem {
    /// A robot at `start` in an empty map, from `start_stamp` on; the covariance of the start is in its body frame, `(x, y, θ)`.
    ///
    /// # Errors
    /// When a parameter is out of range.
    pub(super) fn new(
        params: SlamSystemParams,
        rule: AssociationRule,
        start_stamp: Stamp,
        start: Pose2<f64>,
        start_covariance: &Matrix3<f64>,
    ) -> Result<Self, SlamError> {
        let params = params.validated()?;
        let association = match rule {
            AssociationRule::Known => Rule::Known(KnownIds),
            AssociationRule::Nn => Rule::NearestNeighbour(NearestNeighbour::new(params.nearest_neighbour)?),
            AssociationRule::Jcbb => {
                Rule::JointCompatibility(JointCompatibility::new(params.joint_compatibility)?)
            }
        };
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
        let sensor = ScaledRangeBearingSensor(MountedSensor { sensor: params.sensor, mount });
        let state = ScaledPose { pose: start, log_range_scale: 0.0 };
        let mut covariance = start_covariance.to_homogeneous();
        covariance.m44 = params.robot.range_scale_sigma.powi(2);
        let filter = EkfSlam::with_start_covariance(sensor, filter_params, state, covariance)?;
        Ok(Self {
            observability: params.record_observability.then(|| ObservabilityRecorder::new(&filter)),
            filter,
            association,
            commands: Commands::new(&params.robot),
            motion: MotionStatistics::default(),
            plausible: PlausibleIncrement::default(),
            odometry: None,
            params,
            time: start_stamp,
            past: Past::default(),
            dead_reckoning: start,
            stamped_estimates: Vec::new(),
            events: Events::default(),
            step: Duration::ZERO,
        })
    }

    /// The filter: robot, map, covariance.
    pub fn filter(&self) -> &EkfSlam<PointSensor> {
        &self.filter
    }
    /// Where odometry alone would put the robot.
    pub fn dead_reckoning(&self) -> &Pose2<f64> {
        &self.dead_reckoning
    }
    /// Where the antenna is when the robot is at `pose`.
    pub fn antenna(&self, pose: &Pose2<f64>) -> Vector2<f64> {
        let MountingParams { antenna_x, antenna_y, .. } = self.params.mounting;
        pose.transform(&Vector2::new(antenna_x, antenna_y))
    }
    /// One estimate for every look of the sensor at landmarks.
    pub fn stamped_estimates(&self) -> &[StampedEstimate] {
        &self.stamped_estimates
    }

    /// What the run observed, when that was to be recorded.
    pub fn observability(&self) -> Option<&ObservabilityRecorder> {
        self.observability.as_ref()
    }

    fn take_velocity(&mut self, stamp: Stamp, velocity: Velocity) -> Result<(), String> {
        self.commands.push(stamp, check_velocity(velocity)?);
        self.advance_to(self.exposure(stamp))
    }

    /// A car's encoder and steering are the velocity of its rear axle.
    fn take_drive(&mut self, stamp: Stamp, drive: AckermannDrive) -> Result<(), String> {
        let moved = self.params.vehicle.velocity(drive.wheel_speed, drive.steering, 0.0);
        self.take_velocity(stamp, Velocity { linear: moved.linear, angular: moved.angular })
    }

    fn take_increment(&mut self, stamp: Stamp, increment: &Pose2<f64>) -> Result<(), String> {
        self.plausible.check(stamp, increment)?;
        let stopwatch = Stopwatch::start();
        let motion = ScaledMotion(self.params.increment);
        let before = *self.filter.robot();
        self.filter.predict(&motion, increment).map_err(|error| error.to_string())?;
        self.step += stopwatch.elapsed();
        if let Some(recorder) = &mut self.observability {
            recorder.record_motion(&motion.jacobian(&before, increment));
        }
        self.dead_reckoning = self.dead_reckoning.compose(increment);
        self.time = stamp;
        Ok(())
    }

    fn take_detections(&mut self, stamp: Stamp, detections: &[Detection]) -> Result<(), String> {
        if stamp < self.time {
            self.events.count("before_start");
            return Ok(());
        }
        let observations = self.observations(detections);
        if observations.is_empty() && !detections.is_empty() {
            return Ok(()); // a scan of other robots only has no information about landmarks
        }
        self.advance_to(self.exposure(stamp))?;
        let stopwatch = Stopwatch::start();
        let report = match &mut self.association {
            Rule::Known(rule) => self.filter.update(&observations, rule),
            Rule::NearestNeighbour(rule) => self.filter.update(&observations, rule),
            Rule::JointCompatibility(rule) => self.filter.update(&observations, rule),
        };
        self.step += stopwatch.elapsed();
        let report = report.map_err(|error| error.to_string())?;
        if let Some(recorder) = &mut self.observability {
            recorder.record(&self.filter, &seen_landmarks(&report));
        }
        self.count(&observations, &report);
        for _ in &report.merges {
            self.events.count("merged_landmark");
        }
        self.add_stamped_estimate(stamp, &report);
        Ok(())
    }

    /// A log may tell of the same motion twice, as velocities and as increments; the first kind moves the robot.
    fn moves_by(&mut self, odometry: Odometry) -> bool {
        *self.odometry.get_or_insert(odometry) == odometry
    }

    /// When the sensor saw what has this stamp.
    fn exposure(&self, stamp: Stamp) -> Stamp {
        let latency = (self.params.robot.sensor_latency * 1e9) as u64;
        Stamp::from_nanoseconds(stamp.nanoseconds().saturating_sub(latency))
    }

    /// Moves the robot on with its commands; all of them or none.
    fn advance_to(&mut self, time: Stamp) -> Result<(), String> {
        if time <= self.time {
            return Ok(());
        }
        let stopwatch = Stopwatch::start();
        let controls = self.commands.between(self.time, time);
        let motion = SequentialMotion(self.params.velocity);
        let before = *self.filter.robot();
        let moved = self.filter.predict(&ScaledMotion(motion), controls.as_slice());
        moved.map_err(|error| error.to_string())?;
        if let Some(recorder) = &mut self.observability {
            recorder.record_motion(&ScaledMotion(motion).jacobian(&before, &controls));
        }
        self.dead_reckoning = motion.propagate(&self.dead_reckoning, &controls);
        for control in &self.commands.known_between(self.time, time) {
            let moved = self.params.velocity.propagate(&Pose2::identity(), control);
            self.motion.add(&moved, control.duration);
        }
        self.predict_unknown_motion(self.commands.unknown_seconds(self.time, time))?;
        self.step += stopwatch.elapsed();
        self.commands.forget_before(time);
        self.time = time;
        Ok(())
    }

    /// The robot may have moved as fast as it usually does while nothing told its motion.
    fn predict_unknown_motion(&mut self, seconds: f64) -> Result<(), String> {
        if seconds <= 0.0 {
            return Ok(());
        }
        let hold = self.params.robot.velocity_hold;
        self.events.warn(
            "motion_unknown",
            format!("velocities are missing for more than {hold} s: the motion is unknown there (robot.velocity_hold)"),
        );
        let unknown = ScaledMotion(UnknownMotion(self.motion.unknown_motion(seconds)));
        self.filter.predict(&unknown, &()).map_err(|error| error.to_string())
    }

    /// The filter is at the exposure of the last look; the estimate says where the robot is at its stamp.
    fn add_stamped_estimate(&mut self, stamp: Stamp, report: &StepReport<RangeBearing>) {
        let state = self.filter.robot();
        let motion = ScaledMotion(SequentialMotion(self.params.velocity));
        let controls = self.commands.between(self.time, stamp);
        let jacobian = motion.jacobian(state, &controls);
        let covariance =
            jacobian * self.filter.robot_covariance() * jacobian.transpose() + motion.noise(state, &controls);
        self.stamped_estimates.push(StampedEstimate {
            stamp,
            pose: motion.propagate(state, &controls).pose,
            covariance: covariance.fixed_view::<3, 3>(0, 0).into_owned(),
            dead_reckoning: self.dead_reckoning,
            n_landmarks: self.filter.n_landmarks(),
            nis: report.innovations().fold((0.0, 0), |(sum, n), innovation| (sum + innovation.nis, n + 1)),
            step: std::mem::take(&mut self.step),
        });
    }

    /// What the sensor saw that can be a landmark; the rest is counted.
    fn observations(&mut self, detections: &[Detection]) -> Vec<Observation<RangeBearing>> {
        let mut observations = Vec::with_capacity(detections.len());
        for detection in detections {
            let label = match detection.target {
                Target::Landmark(id) => Some(LandmarkId(id)),
                Target::Unlabelled => None,
                Target::Robot(_) => {
                    self.events.count("robot_detection");
                    continue;
                }
                Target::UnknownCode(_) => {
                    self.events.count("unknown_code");
                    continue;
                }
            };
            let depth_factor = if self.params.robot.range_is_depth { detection.bearing.cos() } else { 1.0 };
            let measurement = RangeBearing::new(detection.range / depth_factor, detection.bearing);
            observations.push(Observation { label, measurement });
        }
        observations
    }

    fn count(&mut self, observations: &[Observation<RangeBearing>], report: &StepReport<RangeBearing>) {
        for (Observation { measurement, .. }, outcome) in observations.iter().zip(&report.outcomes) {
            let name = event_name(outcome);
            match outcome {
                Outcome::Unusable => {
                    let (range, bearing) = (measurement.range, measurement.bearing.radians());
                    let reason = format!("a range of {range} m at {bearing} rad is not usable");
                    self.events.refuse(name, reason);
                }
                Outcome::Duplicate { landmark } => {
                    self.events.refuse(name, format!("landmark {landmark} a second time in one look"));
                }
                _ => self.events.count(name),
            }
        }
    }
}

/// Landmarks that corrected or started in a scan.
pub(crate) fn seen_landmarks<Z>(report: &StepReport<Z>) -> Vec<LandmarkId>
where
    Z: Manifold<Scalar = f64>,
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    let seen = |outcome: &Outcome<Z>| match outcome {
        Outcome::Accepted { landmark, .. }
        | Outcome::Initialized { landmark }
        | Outcome::Restarted { landmark } => Some(*landmark),
        _ => None,
    };
    report.outcomes.iter().filter_map(seen).collect()
}

impl System for SlamSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        if self.past.resumed_at.is_some_and(|resumed_at| record.stamp <= resumed_at) {
            self.events.count("before_resume");
            return Ok(());
        }
        self.past.taken_until = record.stamp;
        match &record.data {
            odometry if Odometry::of(odometry).is_some_and(|kind| !self.moves_by(kind)) => {
                self.events.count("second_odometry");
                Ok(())
            }
            Data::Velocity(velocity) => self.take_velocity(record.stamp, *velocity),
            Data::Ackermann(drive) => self.take_drive(record.stamp, *drive),
            Data::OdometryIncrement(increment) => self.take_increment(record.stamp, increment),
            Data::Detections(detections) => self.take_detections(record.stamp, detections),
            _ => Ok(()),
        }
    }
    fn events(&mut self) -> &mut Events {
        &mut self.events
    }
}
