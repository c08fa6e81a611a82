use std::borrow::Borrow;

use nalgebra::{DefaultAllocator, Vector2};
use wayfix_evaluation::{
    errors::{PoseWithTruth, ReferencePath, TruePositions},
    plot::Decimated,
};
use wayfix_sensor_log::{Record, Stamp};
use wayfix_slam_ekf::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};
use wayfix_system_core::{EventCounts, RunStep, System, drive, warn_of_large_errors, warn_of_no_overlap};

use super::{
    FrontEnd, SlamEstimator, SlamSystem, SmoothedRun, StampedEstimate,
    start::{warn_of_retired_landmarks, warn_of_unseen_anchors},
    warn_of_an_empty_map,
};

/// The result of EKF-SLAM on a log, with the truth of the log; `T` is the true map.
pub struct SlamRun<F: FrontEnd, T>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    /// The system in its last state.
    pub system: SlamSystem<F>,
    /// True poses, or those that another program corrected, where the log has them.
    pub truth: ReferencePath,
    /// True positions of the antenna, where the log has them.
    pub true_positions: TruePositions,
    /// The true map, where the log has it.
    pub true_map: T,
    /// Estimates up to this stamp are compared with the truth.
    pub evaluated_until: Stamp,
    /// What a smoother made of the run, where one followed.
    pub smoothed: Option<SmoothedRun>,
}

impl<F: FrontEnd, T> SlamRun<F, T>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    /// A run before its first record; `truth` is that of the overview of the log.
    pub(crate) fn new(system: SlamSystem<F>, truth: &ReferencePath, true_map: T) -> Self {
        Self {
            system,
            truth: truth.restarted(),
            true_positions: TruePositions::default(),
            true_map,
            evaluated_until: Stamp::from_nanoseconds(u64::MAX),
            smoothed: None,
        }
    }

    /// Passes records through the system and reports the faults of the result.
    pub(crate) fn through(
        mut self,
        records: impl IntoIterator<Item = impl Borrow<Record>>,
        mut observe: impl FnMut(RunStep<'_, SlamSystem<F>>),
    ) -> Self {
        let (truth, positions) = (&mut self.truth, &mut self.true_positions);
        drive(&mut self.system, records, |step| {
            let stamps = || step.system.stamped_estimates().iter().map(|estimate| estimate.stamp);
            truth.take(step.record, stamps());
            positions.take(step.record, stamps());
            observe(step);
        });
        self.take_smoothed();
        let estimates = self.system.stamped_estimates();
        let estimated =
            estimates.first().zip(estimates.last()).map(|(first, last)| (first.stamp, last.stamp));
        warn_of_no_overlap(self.system.events(), &self.truth, estimated);
        let samples: Vec<_> = self.samples().into_iter().map(|(_, sample)| sample).collect();
        warn_of_large_errors(self.system.events(), &self.truth, &samples);
        let n_landmarks = self.system.filter().n_landmarks();
        warn_of_an_empty_map(self.system.events(), n_landmarks);
        let SlamEstimator { filter, events, unseen_anchors, .. } = &mut self.system.estimator;
        warn_of_unseen_anchors(events, unseen_anchors);
        warn_of_retired_landmarks(events, filter.n_retired());
        self
    }

    /// Takes the result of the smoother; with a fixed lag it replaces the estimates of the filter.
    fn take_smoothed(&mut self) {
        let Some(follower) = &mut self.system.estimator.follower else { return };
        match follower.finish() {
            Ok(mut smoothed) => {
                if !smoothed.is_batch {
                    self.system.estimator.stamped_estimates =
                        std::mem::replace(&mut smoothed.estimates, Decimated::new(0));
                }
                if smoothed.n_paired_anew > 0 {
                    self.system.events().add("detection_paired_anew", smoothed.n_paired_anew as u64);
                }
                self.smoothed = Some(smoothed);
            }
            Err(reason) => {
                self.system.events().warn("smoother_failed", reason);
            }
        }
    }

    /// The batch over the same measurements, with true poses; without covariances.
    pub(crate) fn batch_samples(&self) -> Vec<PoseWithTruth> {
        let batch = self.smoothed.as_ref().filter(|smoothed| smoothed.is_batch);
        let estimates = batch.map_or(&[][..], |smoothed| smoothed.estimates.kept());
        let evaluated = estimates.iter().filter(|estimate| estimate.stamp <= self.evaluated_until);
        evaluated.filter_map(|at| self.truth.sample(at.stamp, at.pose, &at.covariance)).collect()
    }

    /// Estimates with their true poses.
    pub fn samples(&self) -> Vec<(StampedEstimate, PoseWithTruth)> {
        let sample = |estimate: &StampedEstimate| {
            let StampedEstimate { stamp, pose, covariance, .. } = estimate;
            Some((*estimate, self.truth.sample(*stamp, *pose, covariance)?))
        };
        self.evaluated().filter_map(sample).collect()
    }

    /// The estimates that are compared with the truth.
    pub(crate) fn evaluated(&self) -> impl Iterator<Item = &StampedEstimate> {
        self.system.stamped_estimates().iter().filter(|estimate| estimate.stamp <= self.evaluated_until)
    }

    /// Estimated positions of `antenna`, which is given the pose, with the true ones, for logs whose truth has no headings.
    pub(crate) fn positions_of(
        &self,
        antenna: impl Fn(&StampedEstimate) -> Vector2<f64>,
    ) -> Vec<(StampedEstimate, Vector2<f64>, Vector2<f64>)> {
        let pair = |estimate: &StampedEstimate| {
            Some((*estimate, antenna(estimate), self.true_positions.near(estimate.stamp)?))
        };
        self.evaluated().filter_map(pair).collect()
    }

    /// What happened.
    pub fn events(&mut self) -> &mut EventCounts {
        self.system.events()
    }
}
