//! The optimum of the motions, walls and pairings of a run: least squares over all keyframes, to compare the filter with.

mod residuals;

use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

use nalgebra::{Matrix1, Matrix2, Matrix3, Matrix4, SMatrix, Vector1, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2, SensorModel};
use wayfix_evaluation::plot::Decimated;
use wayfix_slam_ekf::{
    EkfSlam, LandmarkId, LandmarkModel, MapMeasurement, MountedSensor, Observation, ObservationOutcome,
    PoseWithHeadingDrift, SlamSnapshot, UpdateReport, Wall, WallMeasurement, WallSensor,
};
use wayfix_slam_smoother::{
    ROBUST_KERNEL,
    points::{AntennaPosition, Heading},
};
use wayfix_smoother::{Graph, Params, Prior, ResidualId, SmootherError, Stop, VariableId};
use wayfix_system_core::MOST_ESTIMATES;

use self::residuals::{DriftingMotion, GivenWall, MeasuredDrift, SeenWall};
use super::front_end::WallModel;
use crate::slam::{MAX_BATCH_POSES, NO_BATCH, SlamFollower, SmoothedRun, StampedEstimate};

/// What everything is uncertain by at least, m, rad and rad/m: singular covariances have no information.
const SMALLEST_SIGMA: f64 = 1e-5;

type PoseId = VariableId<Pose2<f64>>;

/// The batch of a run as long as that is not too long.
pub(super) struct WallBatch(Option<WallProblem>);

/// All motions between keyframes, walls and pairings of a run.
struct WallProblem {
    sensor: MountedSensor<WallSensor>,
    start: PoseWithHeadingDrift,
    start_covariance: Matrix4<f64>,
    /// From each keyframe to the next, with its covariance.
    motions: Vec<(DriftingMotion, Matrix3<f64>)>,
    /// The filter's poses at the keyframes, where the batch starts.
    poses: Vec<Pose2<f64>>,
    /// Of all measurements of the heading drift: their information, and their sum in units of it.
    drift_information: f64,
    drift_information_vector: f64,
    /// Number of the keyframe and measurement, for each wall.
    seen: BTreeMap<LandmarkId, Vec<(usize, WallMeasurement)>>,
    /// The filter's walls, where the batch starts.
    walls: BTreeMap<LandmarkId, Wall>,
    anchors: BTreeSet<LandmarkId>,
    /// Walls that the user knows, with their covariances; they are independent of each other and of the start.
    given: BTreeMap<LandmarkId, Vec<(Wall, Matrix2<f64>)>>,
    /// Measurements of the pose after a motion from a keyframe. Their noise includes that motion's, which counts once more in the motion to the next keyframe, as in
    /// the filter.
    measured: Vec<(usize, Pose2<f64>, MapMeasurement)>,
    /// Estimates of the filter, with the number of their keyframe and the motion from it.
    estimates: Decimated<(usize, Pose2<f64>, StampedEstimate)>,
}

impl WallBatch {
    /// A batch that begins where the filter is, with the walls that it has.
    pub(super) fn new(filter: &EkfSlam<WallModel>) -> Self {
        let walls = filter.landmarks().map(|wall| (wall.id, wall.mean));
        Self(Some(WallProblem {
            sensor: filter.model().0,
            start: *filter.robot(),
            start_covariance: filter.robot_covariance(),
            motions: Vec::new(),
            poses: vec![filter.robot().pose],
            drift_information: 0.0,
            drift_information_vector: 0.0,
            seen: BTreeMap::new(),
            walls: walls.chain(filter.anchors().map(|(id, wall)| (id, *wall))).collect(),
            anchors: filter.anchors().map(|(id, _)| id).collect(),
            given: filter.landmarks().map(|wall| (wall.id, vec![(wall.mean, wall.covariance)])).collect(),
            measured: Vec::new(),
            estimates: Decimated::new(MOST_ESTIMATES),
        }))
    }

    /// Gives up a run that is too long.
    fn check_length(&mut self) {
        self.0.take_if(|problem| problem.motions.len().max(problem.measured.len()) > MAX_BATCH_POSES);
    }
}

impl WallProblem {
    fn newest(&self) -> usize {
        self.poses.len() - 1
    }

    /// The poses of the keyframes at the minimum.
    fn solve(&self) -> Result<Vec<Pose2<f64>>, String> {
        let (mut graph, poses) = self.graph().map_err(|error| error.to_string())?;
        let summary = graph.optimize(&Params::default()).map_err(|error| error.to_string())?;
        if summary.stop == Stop::IterationLimit {
            return Err(format!("no minimum after {} iterations", summary.iterations));
        }
        let solved: Result<_, SmootherError> = poses.iter().map(|pose| graph.value(*pose).copied()).collect();
        solved.map_err(|error| error.to_string())
    }

    /// The least squares problem, and its poses.
    fn graph(&self) -> Result<(Graph, Vec<PoseId>), SmootherError> {
        let mut graph = Graph::new();
        let poses: Vec<_> = self.poses.iter().map(|pose| graph.add_variable(*pose)).collect();
        let drift = graph.add_variable(Vector1::new(self.start.heading_drift));
        self.add_start(&mut graph, poses[0], drift)?;
        for ((motion, covariance), ends) in self.motions.iter().zip(poses.windows(2)) {
            graph.add(*motion, (ends[0], ends[1], drift), information(covariance))?;
        }
        if self.drift_information > 0.0 {
            let mean = self.drift_information_vector / self.drift_information;
            graph.add(MeasuredDrift(mean), (drift,), Matrix1::new(self.drift_information))?;
        }
        for (id, sightings) in &self.seen {
            self.add_wall(&mut graph, &poses, *id, sightings)?;
        }
        for (keyframe, motion, measurement) in &self.measured {
            let added = add_measured_pose(&mut graph, poses[*keyframe], motion, measurement)?;
            graph.set_kernel(added, ROBUST_KERNEL)?;
        }
        Ok((graph, poses))
    }

    fn take_keyframe(
        &mut self,
        filter: &EkfSlam<WallModel>,
        observations: &[Observation<WallMeasurement>],
        report: &UpdateReport<WallMeasurement>,
    ) {
        let newest = self.newest();
        self.poses[newest] = filter.robot().pose;
        for (Observation { measurement, .. }, outcome) in observations.iter().zip(&report.outcomes) {
            let id = match outcome {
                ObservationOutcome::Accepted { landmark, .. } => *landmark,
                ObservationOutcome::Initialized { landmark } | ObservationOutcome::Restarted { landmark } => {
                    self.seen.remove(landmark);
                    self.given.remove(landmark);
                    *landmark
                }
                _ => continue,
            };
            self.seen.entry(id).or_default().push((newest, *measurement));
            if let Some(estimate) = filter.landmark(id) {
                self.walls.insert(id, estimate.mean);
            }
        }
        for merge in &report.merges {
            let moved = self.seen.remove(&merge.removed).unwrap_or_default();
            self.seen.entry(merge.kept).or_default().extend(moved);
            if let Some(given) = self.given.remove(&merge.removed) {
                self.given.entry(merge.kept).or_default().extend(given);
            }
        }
        self.seen.retain(|id, _| filter.contains(*id));
        self.walls.retain(|id, _| filter.contains(*id));
        for (id, wall) in filter.anchors() {
            if self.anchors.insert(id) {
                self.seen.remove(&id); // its place is conditional on them already
            }
            self.walls.insert(id, *wall);
        }
    }

    /// A start that is certain is fixed.
    fn add_start(
        &self,
        graph: &mut Graph,
        pose: PoseId,
        drift: VariableId<Vector1<f64>>,
    ) -> Result<(), SmootherError> {
        let of_pose = self.start_covariance.fixed_view::<3, 3>(0, 0).into_owned();
        if of_pose == Matrix3::zeros() {
            graph.fix(pose)?;
        } else {
            graph.add(Prior::new(self.start.pose), (pose,), information(&of_pose))?;
        }
        let of_drift = Matrix1::new(self.start_covariance.m44);
        if of_drift == Matrix1::zeros() {
            graph.fix(drift)?;
        } else {
            graph.add(MeasuredDrift(self.start.heading_drift), (drift,), information(&of_drift))?;
        }
        Ok(())
    }

    fn add_wall(
        &self,
        graph: &mut Graph,
        poses: &[PoseId],
        id: LandmarkId,
        sightings: &[(usize, WallMeasurement)],
    ) -> Result<(), SmootherError> {
        let Some(wall) = self.walls.get(&id) else { return Ok(()) };
        let variable = graph.add_variable(*wall);
        if self.anchors.contains(&id) {
            graph.fix(variable)?;
        } else {
            for (given, covariance) in self.given.get(&id).into_iter().flatten() {
                graph.add(GivenWall(*given), (variable,), information(covariance))?;
            }
        }
        for (keyframe, measurement) in sightings {
            let expected = self.sensor.expected(&self.poses[*keyframe], wall);
            let noise = self.sensor.noise(measurement);
            let noise = self.sensor.noise_at_expected(&expected, measurement, &noise);
            let residual = SeenWall { sensor: self.sensor, measurement: *measurement };
            let added = graph.add(residual, (poses[*keyframe], variable), information(&noise))?;
            graph.set_kernel(added, ROBUST_KERNEL)?;
        }
        Ok(())
    }
}

fn add_measured_pose(
    graph: &mut Graph,
    pose: PoseId,
    motion: &Pose2<f64>,
    measurement: &MapMeasurement,
) -> Result<ResidualId, SmootherError> {
    match measurement {
        MapMeasurement::Position(sensor, measured) => {
            let residual =
                AntennaPosition { antenna: motion.transform(&sensor.antenna), measured: *measured };
            graph.add(residual, (pose,), information(&sensor.covariance))
        }
        MapMeasurement::Heading(sensor, measured) => {
            let residual = Heading { measured: measured.radians() - motion.heading() };
            graph.add(residual, (pose,), information(&Matrix1::new(sensor.variance)))
        }
        MapMeasurement::Pose(sensor, measured) => {
            let carry = motion.adjoint();
            let covariance = carry * sensor.noise(measured) * carry.transpose(); // in the body frame
            let before = measured.compose(&motion.inverse());
            graph.add(Prior::new(before), (pose,), information(&covariance))
        }
    }
}

/// $`(Σ + σ_0^2 I)^{-1}`$; a matrix of NaN, which the graph refuses, if there is none.
fn information<const N: usize>(covariance: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let floored = covariance + SMatrix::<f64, N, N>::identity() * SMALLEST_SIGMA.powi(2);
    let symmetric = floored.symmetric_part();
    nalgebra::Cholesky::new(symmetric)
        .map_or(SMatrix::repeat(f64::NAN), |cholesky| cholesky.inverse())
        .symmetric_part()
}

impl SlamFollower<WallModel> for WallBatch {
    fn predicted(
        &mut self,
        before: &PoseWithHeadingDrift,
        after: &PoseWithHeadingDrift,
        jacobian: &Matrix4<f64>,
        noise: &Matrix4<f64>,
    ) {
        let Some(problem) = &mut self.0 else { return };
        let motion = DriftingMotion {
            motion: before.pose.inverse().compose(&after.pose),
            heading_drift: before.heading_drift,
            drift_jacobian: Vector3::from(jacobian.fixed_view::<3, 1>(0, 3)),
        };
        problem.motions.push((motion, noise.fixed_view::<3, 3>(0, 0).into_owned()));
        problem.poses.push(after.pose);
        self.check_length();
    }

    fn heading_drift_measured(&mut self, measured: f64, information: f64) {
        // A drift that is certain has no information to gain.
        if let Some(problem) = self.0.as_mut().filter(|_| information.is_finite()) {
            problem.drift_information += information;
            problem.drift_information_vector += information * measured;
        }
    }

    fn updated(
        &mut self,
        filter: &EkfSlam<WallModel>,
        observations: &[Observation<WallMeasurement>],
        report: &UpdateReport<WallMeasurement>,
    ) {
        if let Some(problem) = &mut self.0 {
            problem.take_keyframe(filter, observations, report);
        }
    }

    fn measured(&mut self, _: &EkfSlam<WallModel>, measurement: &MapMeasurement, motion: Pose2<f64>) {
        if let Some(problem) = &mut self.0 {
            problem.measured.push((problem.newest(), motion, *measurement));
            self.check_length();
        }
    }

    fn estimated(&mut self, filter: &EkfSlam<WallModel>, estimate: &StampedEstimate) -> Duration {
        if let Some(problem) = &mut self.0 {
            let motion = filter.robot().pose.inverse().compose(&estimate.pose);
            problem.estimates.push((problem.newest(), motion, *estimate));
        }
        Duration::ZERO // a batch is no part of a step
    }

    /// A batch is made anew from a whole log.
    fn save(&self, _: &EkfSlam<WallModel>) -> Option<SlamSnapshot<PoseWithHeadingDrift, Wall>> {
        None
    }

    fn finish(&mut self) -> Result<SmoothedRun, String> {
        let Some(problem) = &self.0 else {
            return Err(format!(
                "{NO_BATCH}: the log has more than {MAX_BATCH_POSES} keyframes or measured poses"
            ));
        };
        let poses = problem.solve().map_err(|reason| format!("{NO_BATCH}: {reason}"))?;
        let mut estimates = Decimated::new(MOST_ESTIMATES);
        for (keyframe, motion, estimate) in problem.estimates.kept() {
            estimates.push(StampedEstimate { pose: poses[*keyframe].compose(motion), ..*estimate });
        }
        Ok(SmoothedRun {
            estimates,
            landmarks: BTreeMap::new(),
            is_batch: true,
            n_paired_anew: 0,
            graph: None,
        })
    }
}

#[cfg(test)]
mod tests;
