use std::{collections::BTreeMap, time::Duration};

use nalgebra::{DefaultAllocator, Matrix3, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2, TangentMatrix};
use wayfix_evaluation::plot::Decimated;
use wayfix_slam_ekf::{
    EkfSlam, LandmarkDim, LandmarkModel, MapMeasurement, MeasurementDim, Observation, RobotDim, SlamAlloc,
    SlamSnapshot, UpdateReport,
};
use wayfix_slam_smoother::SlamSmootherError;

use super::StampedEstimate;

/// Runs with more poses have no batch to compare with.
pub(crate) const MAX_BATCH_POSES: usize = 20_000;

/// What a batch that failed says.
pub(crate) const NO_BATCH: &str = "no batch to compare with";

/// A second estimator that takes the motions of EKF-SLAM, and its pairings at first.
pub(crate) trait SlamFollower<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// The filter has moved the robot, with Jacobian, and noise in the tangent space at the end.
    fn predicted(
        &mut self,
        before: &M::Robot,
        after: &M::Robot,
        jacobian: &TangentMatrix<M::Robot>,
        noise: &TangentMatrix<M::Robot>,
    );
    /// The filter has taken a measurement of the heading drift of a robot that has one, rad/m, with the information that it gained, m²/rad²: less than the sensor has if that is an outlier.
    fn heading_drift_measured(&mut self, _measured: f64, _information: f64) {}
    /// The filter has taken a scan.
    fn updated(
        &mut self,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
        report: &UpdateReport<M::Measurement>,
    );
    /// The filter has taken a measurement of the pose that the robot has after a further motion, whose covariance is part of its noise.
    fn measured(&mut self, filter: &EkfSlam<M>, measurement: &MapMeasurement, motion: Pose2<f64>);
    /// The filter has an estimate at a stamp; computing time of the follower for it.
    fn estimated(&mut self, filter: &EkfSlam<M>, estimate: &StampedEstimate) -> Duration;
    /// Its present estimate of robot and map, in the form of the filter; `None` for a batch, after a failure, and if the window cannot be solved.
    fn save(&self, filter: &EkfSlam<M>) -> Option<SlamSnapshot<M::Robot, M::Landmark>>;
    /// Everything, when the log has ended.
    ///
    /// # Errors
    /// Returns why nothing could be estimated.
    fn finish(&mut self) -> Result<SmoothedRun, String>;
}

/// What a smoother makes of a run.
#[derive(Clone, Debug)]
pub struct SmoothedRun {
    /// One for each estimate of the filter, at the same stamps, or a sample of them.
    pub estimates: Decimated<StampedEstimate>,
    /// Points by identity, of a window.
    pub landmarks: BTreeMap<u32, Vector2<f64>>,
    /// The least squares problem of a batch and its solution, if requested: [`PointSmoother::export`](wayfix_slam_smoother::points::PointSmoother::export).
    pub graph: Option<Result<String, SlamSmootherError>>,
    /// Number of detections that the smoother paired with another landmark than the filter.
    pub n_paired_anew: usize,
    /// Whether it is a batch over the whole log that the filter is compared with, without covariances.
    pub is_batch: bool,
}

/// Whether a smoother follows the filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Smoothing {
    /// There is none.
    #[default]
    Off,
    /// A batch at the end, which shows the distance of the filter from the optimum.
    Reference,
    /// With a fixed lag: its estimates are the result.
    FixedLag,
}

/// $`\mathrm{Ad}_{m^{-1}} Σ \mathrm{Ad}_{m^{-1}}^T`$: a covariance transported along a motion.
pub(crate) fn carried(covariance: &Matrix3<f64>, motion: &Pose2<f64>) -> Matrix3<f64> {
    let carry = motion.inverse().adjoint();
    carry * covariance * carry.transpose()
}
