use std::time::Duration;

use nalgebra::{Matrix4, Vector1, Vector3, Vector4};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};
use wayfix_line_extract::{Extractor, Scan};
use wayfix_scan_match::{Cloud, Matcher};
use wayfix_sensor_log::{Data, LaserScan, Record, Stamp, Velocity};
use wayfix_slam_ekf::{
    DriftingPose, EkfSlam, JointCompatibility, LandmarkId, Mounted, NearestNeighbour,
    Observation, OnDrifting, SeenWall, SlamError, StepReport, Wall, WallSensor,
};

use super::{
    Gait, WallSlamParams,
    travel::{DriftSeen, Travel},
};
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
    matcher: Option<Matcher>,
    /// The scan that was looked at last, which those after it are laid on, and the way since it.
    last_look: Option<Cloud>,
    travel: Travel,
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

/// No robot goes farther from one record to the next, m.
const FARTHEST: f64 = 1e5;
/// Scans that have less in common are not laid on one another, share of points.
const LEAST_OVERLAP: f64 = 0.15;

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
        let matcher = params.match_scans.then(|| Matcher::new(params.scan_match)).transpose()?;
        Ok(Self {
            filter: EkfSlam::with_start_covariance(sensor, params.filter, state, covariance)?,
            extractor,
            matcher,
            last_look: None,
            travel: Travel::default(),
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
        if !(increment.is_finite() && increment.translation.norm() <= FARTHEST) {
            return Err(format!("an increment of {increment:?} is beyond {FARTHEST} m or not finite"));
        }
        self.travel = self.travel.then(&self.params.increment, self.filter.robot().heading_drift, increment);
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
        let LaserScan { angle_min, angle_increment, range_max, ranges } = scan;
        let cloud = Cloud::from_ranges(*angle_min, *angle_increment, ranges, range_max.next_down())
            .map_err(|error| error.to_string())?;
        self.lay_on_the_last_look(&cloud);
        let Gait { least_way, least_turn } = self.params.looks;
        if self.last_look.is_some() && self.travel.is_within(least_way, least_turn) {
            self.events.count("scan_passed_by");
            self.step += stopwatch.elapsed();
            self.add_keyframe(stamp, (0.0, 0));
            return Ok(());
        }
        let observations = self.walls_in(scan)?;
        let travel = std::mem::take(&mut self.travel);
        self.filter.predict(&travel, &travel.motion).map_err(|error| error.to_string())?;
        self.last_look = Some(cloud);
        let report = match &mut self.association {
            Rule::NearestNeighbour(rule) => self.filter.update(&observations, rule),
            Rule::JointCompatibility(rule) => self.filter.update(&observations, rule),
        };
        self.step += stopwatch.elapsed();
        let report = report.map_err(|error| error.to_string())?;
        if std::env::var_os("DBG").is_some() {
            let r = self.filter.robot(); let c = self.filter.robot_covariance();
            eprintln!("POSE {} {} {} {} drift {} sig {} {} {}", stamp.nanoseconds() as f64 * 1e-9, r.pose.x(), r.pose.y(), r.pose.heading(), r.heading_drift, c[(0,0)].sqrt(), c[(1,1)].sqrt(), c[(2,2)].sqrt());
            for (o, out) in observations.iter().zip(&report.outcomes) { eprintln!("OBS rho {:.2} al {:.2} {}", o.measurement.line.rho, o.measurement.line.alpha, match out { wayfix_slam_ekf::Outcome::Accepted { landmark, innovation, noise_scale } => format!("{landmark} nis {:.1} scale {noise_scale:.1} res {:.2} {:.3}", innovation.nis, innovation.residual[0], innovation.residual[1]), wayfix_slam_ekf::Outcome::Initialized { landmark } => format!("NEW {landmark}"), other => format!("{other:?}") }); }
        }
        self.count(&report);
        let nis = report.innovations().fold((0.0, 0), |(sum, n), innovation| (sum + innovation.nis, n + 1));
        self.add_keyframe(stamp, nis);
        Ok(())
    }

    /// The filter is at the last scan that was used; the keyframe says where the robot is by now.
    fn add_keyframe(&mut self, stamp: Stamp, nis: (f64, usize)) {
        let (state, travel) = (self.filter.robot(), &self.travel);
        let jacobian = travel.jacobian(state, &travel.motion);
        let covariance = jacobian * self.filter.robot_covariance() * jacobian.transpose()
            + travel.noise(state, &travel.motion);
        self.keyframes.push(Keyframe {
            stamp,
            pose: travel.propagate(state, &travel.motion).pose,
            covariance: covariance.fixed_view::<3, 3>(0, 0).into_owned(),
            dead_reckoning: self.dead_reckoning,
            n_landmarks: self.filter.n_landmarks(),
            nis,
            step: std::mem::take(&mut self.step),
        });
    }

    /// Corrects the way since the last look, and the drift, by how a scan lies on that of the last look.
    fn lay_on_the_last_look(&mut self, cloud: &Cloud) {
        self.travel = self.travel.at_a_scan(self.params.scan_sigma, self.params.scan_heading_sigma);
        let (Some(last), Some(matcher)) = (&self.last_look, self.matcher) else { return };
        let drift_variance = self.filter.robot_covariance()[(3, 3)];
        let covariance = self.travel.total_covariance(drift_variance);
        let found = matcher.align(last, cloud, &self.travel.motion, &covariance);
        let Some(found) = found.ok().filter(|found| found.overlap >= LEAST_OVERLAP) else {
            self.events.count("scan_unmatched");
            return;
        };
        if std::env::var_os("DBG").is_some() { eprintln!("MATCH {:?} {:?} scale {:.2} overlap {:.2}", self.travel.motion, found.correction.as_slice(), found.guess_scale, found.overlap); }
        self.events.count("scan_matched");
        let travel = self.travel.doubted(found.guess_scale);
        let drift = self.filter.robot().heading_drift;
        if let Some((change, variance)) = travel.drift_seen(&found) {
            // A look at the drift that the filter refuses leaves it as it is.
            self.filter.update_robot(&DriftSeen(variance), &Vector1::new(drift + change)).ok();
        }
        let drift_change = self.filter.robot().heading_drift - drift;
        self.travel = travel.corrected_by(&found, drift_change).unwrap_or(travel);
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
