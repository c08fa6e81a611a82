//! The optimum of the motions, walls and pairings of a run: least squares over all keyframes, to compare the filter with.

mod residuals;

use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

use nalgebra::{Matrix1, Matrix3, Matrix4, SMatrix, Vector1, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2, SensorModel};
use wayfix_evaluation::plot::Decimated;
use wayfix_slam_ekf::{
    EkfSlam, LandmarkId, LandmarkModel, MapMeasurement, MountedSensor, Observation, ObservationOutcome,
    PoseWithHeadingDrift, SlamSnapshot, UpdateReport, Wall, WallMeasurement, WallSensor,
};
use wayfix_slam_smoother::points::{AntennaPosition, Heading};
use wayfix_smoother::{Graph, Params, Prior, SmootherError, VariableId};
use wayfix_system_core::MOST_ESTIMATES;

use self::residuals::{DriftingMotion, MeasuredDrift, SeenWall};
use super::front_end::WallModel;
use crate::slam::{MAX_BATCH_POSES, SlamFollower, SmoothedRun, StampedEstimate};

/// What motions and starts are uncertain by at least, m and rad: singular covariances have no information.
const SMALLEST_SIGMA: f64 = 1e-5;

/// All motions between keyframes, walls and pairings of a run.
pub(super) struct WallBatch {
    sensor: MountedSensor<WallSensor>,
    start: PoseWithHeadingDrift,
    start_covariance: Matrix4<f64>,
    /// From each keyframe to the next, with its covariance.
    motions: Vec<(DriftingMotion, Matrix3<f64>)>,
    /// The filter's poses at the keyframes, where the batch starts.
    poses: Vec<Pose2<f64>>,
    /// Measured heading drifts and their variances.
    heading_drifts: Vec<(f64, f64)>,
    /// Number of the keyframe and measurement, for each wall.
    seen: BTreeMap<LandmarkId, Vec<(usize, WallMeasurement)>>,
    /// The filter's walls, where the batch starts.
    walls: BTreeMap<LandmarkId, Wall>,
    anchors: BTreeSet<LandmarkId>,
    /// Measurements of the pose after a motion from a keyframe.
    measured: Vec<(usize, Pose2<f64>, MapMeasurement)>,
    /// Estimates of the filter, with the number of their keyframe and the motion from it.
    estimates: Decimated<(usize, Pose2<f64>, StampedEstimate)>,
}

impl WallBatch {
    /// A batch that begins where the filter is.
    pub(super) fn new(filter: &EkfSlam<WallModel>) -> Self {
        Self {
            sensor: filter.model().0,
            start: *filter.robot(),
            start_covariance: filter.robot_covariance(),
            motions: Vec::new(),
            poses: vec![filter.robot().pose],
            heading_drifts: Vec::new(),
            seen: BTreeMap::new(),
            walls: BTreeMap::new(),
            anchors: BTreeSet::new(),
            measured: Vec::new(),
            estimates: Decimated::new(MOST_ESTIMATES),
        }
    }

    fn is_too_long(&self) -> bool {
        self.poses.len() > MAX_BATCH_POSES
    }

    fn newest(&self) -> usize {
        self.poses.len() - 1
    }

    /// The poses of the keyframes at the minimum.
    fn solve(&self) -> Result<Vec<Pose2<f64>>, SmootherError> {
        let mut graph = Graph::new();
        let poses: Vec<_> = self.poses.iter().map(|pose| graph.add_variable(*pose)).collect();
        let drift = graph.add_variable(Vector1::new(self.start.heading_drift));
        self.add_start(&mut graph, poses[0], drift)?;
        for ((motion, covariance), ends) in self.motions.iter().zip(poses.windows(2)) {
            graph.add(*motion, (ends[0], ends[1], drift), information(covariance))?;
        }
        for (measured, variance) in &self.heading_drifts {
            graph.add(MeasuredDrift(*measured), (drift,), information(&Matrix1::new(*variance)))?;
        }
        for (id, sightings) in &self.seen {
            self.add_wall(&mut graph, &poses, *id, sightings)?;
        }
        for (keyframe, motion, measurement) in &self.measured {
            add_measured_pose(&mut graph, poses[*keyframe], motion, measurement)?;
        }
        graph.optimize(&Params::default())?;
        poses.iter().map(|pose| graph.value(*pose).copied()).collect()
    }

    /// A start that is certain is fixed.
    fn add_start(
        &self,
        graph: &mut Graph,
        pose: VariableId<Pose2<f64>>,
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
        poses: &[VariableId<Pose2<f64>>],
        id: LandmarkId,
        sightings: &[(usize, WallMeasurement)],
    ) -> Result<(), SmootherError> {
        let Some(wall) = self.walls.get(&id) else { return Ok(()) };
        let variable = graph.add_variable(*wall);
        if self.anchors.contains(&id) {
            graph.fix(variable)?;
        }
        for (keyframe, measurement) in sightings {
            let expected = self.sensor.expected(&self.poses[*keyframe], wall);
            let noise = self.sensor.noise(measurement);
            let noise = self.sensor.noise_at_expected(&expected, measurement, &noise);
            let residual = SeenWall { sensor: self.sensor, measurement: *measurement };
            graph.add(residual, (poses[*keyframe], variable), information(&noise))?;
        }
        Ok(())
    }
}

fn add_measured_pose(
    graph: &mut Graph,
    pose: VariableId<Pose2<f64>>,
    motion: &Pose2<f64>,
    measurement: &MapMeasurement,
) -> Result<(), SmootherError> {
    match measurement {
        MapMeasurement::Position(sensor, measured) => {
            let residual =
                AntennaPosition { antenna: motion.transform(&sensor.antenna), measured: *measured };
            graph.add(residual, (pose,), information(&sensor.covariance))?;
        }
        MapMeasurement::Heading(sensor, measured) => {
            let residual = Heading { measured: measured.radians() - motion.heading() };
            graph.add(residual, (pose,), information(&Matrix1::new(sensor.variance)))?;
        }
        MapMeasurement::Pose(sensor, measured) => {
            let carry = motion.adjoint();
            let covariance = carry * sensor.noise(measured) * carry.transpose(); // in the body frame
            let before = measured.compose(&motion.inverse());
            graph.add(Prior::new(before), (pose,), information(&covariance))?;
        }
    }
    Ok(())
}

/// $`(Σ + σ_0^2 I)^{-1}`$; a matrix of NaN, which the graph refuses, if there is none.
fn information<const N: usize>(covariance: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let floored = covariance + SMatrix::<f64, N, N>::identity() * SMALLEST_SIGMA.powi(2);
    let symmetric = (floored + floored.transpose()) * 0.5;
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
        if self.is_too_long() {
            return;
        }
        let motion = DriftingMotion {
            motion: before.pose.inverse().compose(&after.pose),
            heading_drift: before.heading_drift,
            drift_jacobian: Vector3::from(jacobian.fixed_view::<3, 1>(0, 3)),
        };
        self.motions.push((motion, noise.fixed_view::<3, 3>(0, 0).into_owned()));
        self.poses.push(after.pose);
    }

    fn heading_drift_measured(&mut self, measured: f64, variance: f64) {
        if !self.is_too_long() {
            self.heading_drifts.push((measured, variance));
        }
    }

    fn updated(
        &mut self,
        filter: &EkfSlam<WallModel>,
        observations: &[Observation<WallMeasurement>],
        report: &UpdateReport<WallMeasurement>,
    ) {
        if self.is_too_long() {
            return;
        }
        let newest = self.newest();
        self.poses[newest] = filter.robot().pose;
        for (Observation { measurement, .. }, outcome) in observations.iter().zip(&report.outcomes) {
            let id = match outcome {
                ObservationOutcome::Accepted { landmark, .. } => *landmark,
                ObservationOutcome::Initialized { landmark } | ObservationOutcome::Restarted { landmark } => {
                    self.seen.remove(landmark);
                    *landmark
                }
                _ => continue,
            };
            self.seen.entry(id).or_default().push((newest, *measurement));
        }
        for merge in &report.merges {
            let moved = self.seen.remove(&merge.removed).unwrap_or_default();
            self.seen.entry(merge.kept).or_default().extend(moved);
        }
        self.seen.retain(|id, _| filter.contains(*id));
        for (id, wall) in filter.anchors() {
            self.anchors.insert(id);
            self.walls.insert(id, *wall);
        }
        for id in self.seen.keys() {
            if let Some(estimate) = filter.landmark(*id) {
                self.walls.insert(*id, estimate.mean);
            }
        }
    }

    fn measured(&mut self, _: &EkfSlam<WallModel>, measurement: &MapMeasurement, motion: Pose2<f64>) {
        if !self.is_too_long() {
            self.measured.push((self.newest(), motion, *measurement));
        }
    }

    fn estimated(&mut self, filter: &EkfSlam<WallModel>, estimate: &StampedEstimate) -> Duration {
        if !self.is_too_long() {
            let motion = filter.robot().pose.inverse().compose(&estimate.pose);
            self.estimates.push((self.newest(), motion, *estimate));
        }
        Duration::ZERO // a batch is no part of a step
    }

    /// A batch is made anew from a whole log.
    fn save(&self, _: &EkfSlam<WallModel>) -> Option<SlamSnapshot<PoseWithHeadingDrift, Wall>> {
        None
    }

    fn finish(&mut self) -> Result<SmoothedRun, String> {
        if self.is_too_long() {
            return Err(format!("the log has more than {MAX_BATCH_POSES} keyframes"));
        }
        let poses = self.solve().map_err(|error| error.to_string())?;
        let mut estimates = Decimated::new(MOST_ESTIMATES);
        for (keyframe, motion, estimate) in self.estimates.kept() {
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
