use std::{collections::BTreeSet, time::Duration};

use nalgebra::{DMatrix, DefaultAllocator, Dim, Matrix3, OMatrix, allocator::Allocator};
use wayfix_estimation_traits::{LieGroup, Manifold, MotionModel, Pose2, TangentMatrix};
use wayfix_evaluation::plot::Decimated;
use wayfix_sensor_log::Stamp;
use wayfix_slam_ekf::{
    AnyAssociation, EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, Observation,
    ObservationOutcome, RobotDim, SlamAlloc, UpdateReport, observability::ObservabilityRecorder,
};
use wayfix_system_core::{EventCounts, MOST_ESTIMATES};

use super::SlamFollower;

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

/// EKF-SLAM with its rule of association, and what a run records of it.
pub struct SlamEstimator<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(crate) filter: EkfSlam<M>,
    pub(super) association: AnyAssociation,
    pub(super) observability: Option<ObservabilityRecorder>,
    /// Smoothes what the filter pairs.
    pub(crate) follower: Option<Box<dyn SlamFollower<M>>>,
    pub(crate) dead_reckoning: Pose2<f64>,
    pub(crate) stamped_estimates: Decimated<StampedEstimate>,
    /// Those that came with the last record.
    pub(super) newest_estimates: Vec<StampedEstimate>,
    /// Longest computing time of an estimate.
    pub(super) longest_step: Duration,
    pub(crate) events: EventCounts,
    /// Given anchors that no observation has matched.
    pub(super) unseen_anchors: BTreeSet<LandmarkId>,
    /// Computing time since the last estimate.
    pub(crate) step: Duration,
}

impl<M: LandmarkModel> SlamEstimator<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// A filter before its first record. Dead reckoning begins at `start`.
    pub fn new(
        filter: EkfSlam<M>,
        association: AnyAssociation,
        records_observability: bool,
        start: Pose2<f64>,
    ) -> Self {
        Self {
            observability: records_observability.then(|| ObservabilityRecorder::new(&filter)),
            filter,
            association,
            follower: None,
            dead_reckoning: start,
            stamped_estimates: Decimated::new(MOST_ESTIMATES),
            newest_estimates: Vec::new(),
            longest_step: Duration::ZERO,
            events: EventCounts::default(),
            unseen_anchors: BTreeSet::new(),
            step: Duration::ZERO,
        }
    }

    /// What happened so far: counts and warnings.
    pub fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }

    /// The filter: robot, map, covariance.
    pub fn filter(&self) -> &EkfSlam<M> {
        &self.filter
    }

    /// Moves the robot.
    ///
    /// # Errors
    /// Returns why the filter refuses the motion; it is then unchanged.
    pub fn predict<U: ?Sized>(
        &mut self,
        motion: &impl MotionModel<State = M::Robot, Control = U>,
        control: &U,
    ) -> Result<(), String> {
        let jacobian = motion.jacobian(self.filter.robot(), control);
        self.predict_unrecorded(motion, control)?;
        if let Some(recorder) = &mut self.observability {
            recorder.record_motion(&dynamic(&jacobian));
        }
        Ok(())
    }

    /// Moves the robot by a motion that is no part of the linearization that observability is judged by.
    pub(crate) fn predict_unrecorded<U: ?Sized>(
        &mut self,
        motion: &impl MotionModel<State = M::Robot, Control = U>,
        control: &U,
    ) -> Result<(), String> {
        let before = self.filter.robot().clone();
        self.filter.predict(motion, control).map_err(|error| error.to_string())?;
        if let Some(follower) = &mut self.follower {
            let jacobian = motion.jacobian(&before, control);
            follower.predicted(&before, self.filter.robot(), &jacobian, &motion.noise(&before, control));
        }
        Ok(())
    }

    /// Moves the robot by odometry alone, to compare with.
    pub fn move_dead_reckoning(&mut self, increment: &Pose2<f64>) {
        self.dead_reckoning = self.dead_reckoning.compose(increment);
    }

    /// Corrects robot and map by the observations of one scan. Counts their outcomes; `describe` gives the text for an unusable one.
    ///
    /// # Errors
    /// Returns why the filter refuses the scan; it is then unchanged.
    pub fn update(
        &mut self,
        observations: &[Observation<M::Measurement>],
        describe: impl Fn(&M::Measurement) -> String,
    ) -> Result<UpdateReport<M::Measurement>, String> {
        let report = self.filter.update(observations, &mut self.association);
        let report = report.map_err(|error| error.to_string())?;
        if !self.unseen_anchors.is_empty() {
            let seen = seen_landmarks(&report);
            self.unseen_anchors.retain(|anchor| !seen.contains(anchor));
        }
        if let Some(recorder) = &mut self.observability {
            recorder.record(&self.filter, &seen_landmarks(&report));
        }
        if let Some(follower) = &mut self.follower {
            follower.updated(&self.filter, observations, &report);
        }
        for (Observation { measurement, .. }, outcome) in observations.iter().zip(&report.outcomes) {
            let name = outcome.event_name();
            match outcome {
                ObservationOutcome::Unusable => {
                    self.events.refuse(name, format!("{} is not usable", describe(measurement)));
                }
                ObservationOutcome::Duplicate { landmark }
                    if matches!(self.association, AnyAssociation::Known(_)) =>
                {
                    self.events.refuse(name, format!("landmark {landmark} a second time in one scan"));
                }
                _ => self.events.count(name),
            }
        }
        for _ in &report.merges {
            self.events.count("landmarks_merged");
        }
        Ok(report)
    }

    /// Records a correction of the robot's own state.
    pub(crate) fn record_robot(&mut self, jacobian: &DMatrix<f64>, covariance: &DMatrix<f64>) {
        if let Some(recorder) = &mut self.observability {
            recorder.record_robot(&self.filter, jacobian, covariance);
        }
    }

    /// The robot after a motion that the filter has not made, and its covariance.
    pub(crate) fn predicted<U: ?Sized>(
        &self,
        motion: &impl MotionModel<State = M::Robot, Control = U>,
        control: &U,
    ) -> (M::Robot, TangentMatrix<M::Robot>) {
        let state = self.filter.robot();
        let jacobian = motion.jacobian(state, control);
        let covariance =
            &jacobian * self.filter.robot_covariance() * jacobian.transpose() + motion.noise(state, control);
        (motion.propagate(state, control), covariance)
    }

    /// Adds the estimate at a stamp: pose, covariance in the body frame, and [`nis`] of what corrected.
    pub fn add_stamped_estimate(
        &mut self,
        stamp: Stamp,
        pose: Pose2<f64>,
        covariance: Matrix3<f64>,
        nis: (f64, usize),
    ) {
        let mut estimate = StampedEstimate {
            stamp,
            pose,
            covariance,
            dead_reckoning: self.dead_reckoning,
            n_landmarks: self.filter.n_landmarks(),
            nis,
            step: std::mem::take(&mut self.step),
        };
        if let Some(follower) = &mut self.follower {
            estimate.step += follower.estimated(&self.filter, &estimate);
        }
        self.longest_step = self.longest_step.max(estimate.step);
        self.newest_estimates.push(estimate);
        self.stamped_estimates.push(estimate);
    }
}

/// Sum and number of the NIS of what corrected.
pub fn nis<Z: Manifold<Scalar = f64>>(report: &UpdateReport<Z>) -> (f64, usize)
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    report.innovations().fold((0.0, 0), |(sum, n), innovation| (sum + innovation.nis, n + 1))
}

/// Landmarks that corrected or started in a scan.
fn seen_landmarks<Z: Manifold<Scalar = f64>>(report: &UpdateReport<Z>) -> Vec<LandmarkId>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    let seen = |outcome: &ObservationOutcome<Z>| match outcome {
        ObservationOutcome::Accepted { landmark, .. }
        | ObservationOutcome::Initialized { landmark }
        | ObservationOutcome::Restarted { landmark } => Some(*landmark),
        _ => None,
    };
    report.outcomes.iter().filter_map(seen).collect()
}

fn dynamic<R: Dim, C: Dim>(matrix: &OMatrix<f64, R, C>) -> DMatrix<f64>
where
    DefaultAllocator: Allocator<R, C>,
{
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| matrix[(row, column)])
}
