use std::{collections::BTreeMap, time::Duration};

use nalgebra::{Matrix3, Matrix4, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2, SensorModel};
use wayfix_evaluation::plot::Decimated;
use wayfix_slam_ekf::{
    EkfSlam, LandmarkId, LandmarkModel, MapMeasurement, Observation, ObservationOutcome, PoseWithRangeScale,
    RangeBearing, SlamSnapshot, UpdateReport,
};
use wayfix_slam_smoother::{
    SlamSmootherError,
    points::{Detection, PointMapGaussian, PointSmoother, PointSmootherParams, PoseObservation, SettledPose},
};
use wayfix_system_core::{MOST_ESTIMATES, Stopwatch};

use super::{PointSensor, PointSlamParams};
use crate::slam::{
    AssociationRule, MAX_BATCH_POSES, NO_BATCH, SlamFollower, SmoothedRun, Smoothing, StampedEstimate,
    carried,
};

/// Poses older than this are final, s.
const LAG: f64 = 60.0;
/// Time between two solutions of the window, s.
const PERIOD: f64 = 1.0;

/// The smoother of points behind EKF-SLAM: motions and first pairings come from the filter.
pub(super) struct PointFollower {
    smoother: PointSmoother,
    is_batch: bool,
    is_graph_recorded: bool,
    /// Motion since the newest pose of the smoother, with covariance.
    motion: Pose2<f64>,
    covariance: Matrix3<f64>,
    waiting: BTreeMap<usize, Vec<Waiting>>,
    estimates: Decimated<StampedEstimate>,
    failure: Option<String>,
}

/// An estimate of the filter that waits for the pose of the smoother before it.
struct Waiting {
    estimate: StampedEstimate,
    motion: Pose2<f64>,
    covariance: Matrix3<f64>,
}

impl PointFollower {
    /// The follower that the parameters request; it starts from the state of a filter.
    pub(super) fn wanted(
        params: &PointSlamParams,
        rule: AssociationRule,
        filter: &EkfSlam<PointSensor>,
    ) -> Result<Option<Box<dyn SlamFollower<PointSensor>>>, SlamSmootherError> {
        let is_batch = match params.smoothing {
            Smoothing::Off => return Ok(None),
            Smoothing::Reference => true,
            Smoothing::FixedLag => false,
        };
        let SlamSnapshot { robot, landmarks, .. } = filter.snapshot();
        let start = PointMapGaussian {
            pose: robot.pose,
            log_range_scale: robot.log_range_scale,
            landmarks: landmarks.into_iter().map(|landmark| (landmark.id.0, landmark.mean)).collect(),
            covariance: filter.covariance(),
        };
        let mount = filter.model().0.mount;
        let smoother_params = PointSmootherParams {
            lag: (!is_batch).then_some(LAG),
            period: PERIOD,
            mount,
            pairs_anew: rule != AssociationRule::Known,
        };
        Ok(Some(Box::new(Self {
            smoother: PointSmoother::new(smoother_params, &start)?,
            is_batch,
            is_graph_recorded: params.record_graph,
            motion: Pose2::identity(),
            covariance: Matrix3::zeros(),
            waiting: BTreeMap::new(),
            estimates: Decimated::new(MOST_ESTIMATES),
            failure: None,
        })))
    }

    /// Does something unless an earlier step has failed.
    fn try_to(&mut self, act: impl FnOnce(&mut Self) -> Result<(), SlamSmootherError>) {
        if self.failure.is_none()
            && let Err(error) = act(self)
        {
            self.fail(error.to_string());
        }
    }

    /// Ends the smoother; what waits for it is of no use.
    fn fail(&mut self, reason: String) {
        self.failure = Some(reason);
        self.waiting.clear();
    }

    /// Adds a pose to the smoother where the filter is.
    fn advance(&mut self, filter: &EkfSlam<PointSensor>) -> Result<(), SlamSmootherError> {
        if self.is_batch && self.smoother.newest() >= MAX_BATCH_POSES {
            self.fail(format!("the log has more than {MAX_BATCH_POSES} scans and measured poses"));
            return Ok(());
        }
        let guess = self.is_batch.then(|| filter.robot().pose);
        self.smoother.advance(self.motion, &self.covariance, guess)?;
        (self.motion, self.covariance) = (Pose2::identity(), Matrix3::zeros());
        Ok(())
    }

    fn take_scan(
        &mut self,
        filter: &EkfSlam<PointSensor>,
        observations: &[Observation<RangeBearing>],
        report: &UpdateReport<RangeBearing>,
    ) -> Result<(), SlamSmootherError> {
        self.advance(filter)?;
        for (Observation { measurement, .. }, outcome) in observations.iter().zip(&report.outcomes) {
            let landmark = match outcome {
                ObservationOutcome::Accepted { landmark, .. } => *landmark,
                ObservationOutcome::Initialized { landmark } | ObservationOutcome::Restarted { landmark } => {
                    self.smoother.remove(landmark.0)?;
                    *landmark
                }
                _ => continue,
            };
            let RangeBearing { range, bearing } = *measurement;
            let covariance = filter.model().noise(measurement);
            self.smoother.detect(landmark.0, &Detection { range, bearing: bearing.radians(), covariance })?;
        }
        for merge in &report.merges {
            self.smoother.merge(merge.kept.0, merge.removed.0)?;
        }
        for (id, place) in filter.anchors() {
            self.smoother.add_anchor(id.0, *place)?;
        }
        let gone: Vec<u32> = self.smoother.landmarks().into_keys().collect();
        for landmark in gone.into_iter().filter(|id| !filter.contains(LandmarkId(*id))) {
            self.smoother.remove(landmark)?;
        }
        Ok(())
    }

    /// Puts settled poses into the estimates that wait for them.
    fn settle(&mut self, settled: &[SettledPose]) {
        for SettledPose { number, pose, covariance } in settled {
            for Waiting { estimate, motion, covariance: added } in
                self.waiting.remove(number).unwrap_or_default()
            {
                let covariance = carried(covariance, &motion) + added;
                self.estimates.push(StampedEstimate { pose: pose.compose(&motion), covariance, ..estimate });
            }
        }
    }
}

impl SlamFollower<PointSensor> for PointFollower {
    fn predicted(
        &mut self,
        before: &PoseWithRangeScale,
        after: &PoseWithRangeScale,
        _: &Matrix4<f64>,
        noise: &Matrix4<f64>,
    ) {
        let step = before.pose.inverse().compose(&after.pose);
        self.covariance = carried(&self.covariance, &step) + noise.fixed_view::<3, 3>(0, 0);
        self.motion = self.motion.compose(&step);
    }

    fn updated(
        &mut self,
        filter: &EkfSlam<PointSensor>,
        observations: &[Observation<RangeBearing>],
        report: &UpdateReport<RangeBearing>,
    ) {
        self.try_to(|follower| follower.take_scan(filter, observations, report));
    }

    fn measured(&mut self, filter: &EkfSlam<PointSensor>, measurement: &MapMeasurement, motion: Pose2<f64>) {
        let observation = match *measurement {
            MapMeasurement::Position(sensor, measured) => {
                PoseObservation::Position { antenna: sensor.antenna, measured, covariance: sensor.covariance }
            }
            MapMeasurement::Heading(sensor, measured) => PoseObservation::Heading {
                measured: measured.radians(),
                variance: nalgebra::Matrix1::new(sensor.variance),
            },
            MapMeasurement::Pose(sensor, measured) => {
                PoseObservation::Pose { measured, covariance: sensor.noise(&measured) }
            }
        };
        self.try_to(|follower| {
            follower.advance(filter)?;
            follower.smoother.observe(&observation, &motion)
        });
    }

    fn estimated(&mut self, filter: &EkfSlam<PointSensor>, estimate: &StampedEstimate) -> Duration {
        let stopwatch = Stopwatch::start();
        let motion = filter.robot().pose.inverse().compose(&estimate.pose);
        let of_filter = filter.robot_covariance().fixed_view::<3, 3>(0, 0).into_owned();
        let covariance = estimate.covariance - carried(&of_filter, &motion);
        let mut settled = Vec::new();
        self.try_to(|follower| {
            settled = follower.smoother.step(estimate.stamp.seconds())?;
            Ok(())
        });
        // A batch is no part of a step.
        let step = if self.is_batch { Duration::ZERO } else { stopwatch.elapsed() };
        if self.failure.is_none() {
            let estimate = StampedEstimate { step: estimate.step + step, ..*estimate };
            let waiting = Waiting { estimate, motion, covariance };
            self.waiting.entry(self.smoother.newest()).or_default().push(waiting);
            self.settle(&settled);
        }
        step
    }

    fn save(&self, filter: &EkfSlam<PointSensor>) -> Option<SlamSnapshot<PoseWithRangeScale, Vector2<f64>>> {
        let mut saved = filter.snapshot();
        saved.landmarks.retain(|landmark| self.smoother.contains(landmark.id.0));
        let ids = saved.landmarks.iter().map(|landmark| landmark.id.0);
        let is_whole = !self.is_batch && self.failure.is_none();
        let window = is_whole.then(|| self.smoother.gaussian(ids, &self.motion, &self.covariance))?.ok()?;
        saved.robot = PoseWithRangeScale { pose: window.pose, log_range_scale: window.log_range_scale };
        for (landmark, (_, place)) in saved.landmarks.iter_mut().zip(window.landmarks) {
            landmark.mean = place;
        }
        saved.set_covariance(&window.covariance);
        Some(saved)
    }

    fn finish(&mut self) -> Result<SmoothedRun, String> {
        let mut graph = (self.is_batch && self.is_graph_recorded).then(|| self.smoother.export());
        self.try_to(|follower| {
            let settled = follower.smoother.finish()?;
            follower.settle(&settled);
            if let Some(Ok(graph)) = &mut graph {
                graph.push_str(&follower.smoother.export_solution()?);
            }
            Ok(())
        });
        if let Some(reason) = &self.failure {
            let what = if self.is_batch { NO_BATCH } else { "no smoothed estimates" };
            return Err(format!("{what}: {reason}"));
        }
        Ok(SmoothedRun {
            estimates: std::mem::replace(&mut self.estimates, Decimated::new(0)),
            landmarks: self.smoother.landmarks(),
            is_batch: self.is_batch,
            n_paired_anew: self.smoother.n_paired_anew(),
            graph,
        })
    }
}
