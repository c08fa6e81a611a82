use nalgebra::{DefaultAllocator, Matrix3, Vector2};
use serde::{Serialize, de::DeserializeOwned};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{LogError, Record, Stamp};
use wayfix_slam_ekf::{
    EkfSlam, ExternalParams, LandmarkDim, LandmarkModel, MeasurementDim, PlanarRobot, RobotDim, SlamAlloc,
};
use wayfix_system_core::EstimateWriter;

use super::SlamEstimator;

/// A motion, and its covariance in the body frame at its end.
pub type MotionEstimate = (Pose2<f64>, Matrix3<f64>);

/// What turns the records of a log into predictions and updates of EKF-SLAM, for one kind of landmark.
pub trait FrontEnd
where
    DefaultAllocator: SlamAlloc<RobotDim<Self::Model>, LandmarkDim<Self::Model>, MeasurementDim<Self::Model>>,
{
    /// Robot, landmark and measurement.
    type Model: LandmarkModel<Robot: PlanarRobot> + Clone;
    /// What it keeps between two records.
    type State: FrontEndState;

    /// Takes a record: predicts and updates.
    ///
    /// # Errors
    /// Returns why the record was refused; everything is as before it.
    fn take(&mut self, record: &Record, estimator: &mut SlamEstimator<Self::Model>) -> Result<(), String>;

    /// Uses what still waits for a later record at the end of the log.
    ///
    /// # Errors
    /// Returns why it cannot be used.
    fn finish(&mut self, _: &mut SlamEstimator<Self::Model>) -> Result<(), String> {
        Ok(())
    }

    /// Parameters of sensors that do not use the map, and the antenna in the robot frame, m.
    fn external(&self) -> (&ExternalParams, Vector2<f64>);

    /// Moves the robot to a stamp. Returns the motion that the filter has not made; `None` before the run starts.
    ///
    /// # Errors
    /// Returns why it cannot be moved.
    fn motion_to(
        &mut self,
        stamp: Stamp,
        estimator: &mut SlamEstimator<Self::Model>,
    ) -> Result<Option<MotionEstimate>, String>;

    /// The filter has taken or refused a measurement of the pose: its robot was at `before`. What was computed from it, as a motion that
    /// [`motion_to`](Self::motion_to) gives, may have to follow.
    fn corrected(
        &mut self,
        _before: &<Self::Model as LandmarkModel>::Robot,
        _after: &<Self::Model as LandmarkModel>::Robot,
    ) {
    }

    /// The stamp up to which records changed the state, where `taken_until` is the stamp of the last record.
    fn settled_until(&self, taken_until: Stamp) -> Stamp {
        taken_until
    }

    /// Draws the map for viewers.
    ///
    /// # Errors
    /// Returns an error if it cannot be written.
    fn draw_map(
        filter: &EkfSlam<Self::Model>,
        stamp: Stamp,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError>;

    /// All that it needs to continue.
    fn state(&self) -> Self::State;
}

/// What a front end saves, and which kind of map it belongs to.
pub trait FrontEndState: Serialize + DeserializeOwned {
    /// The robot's state in words, and its dimension.
    const ROBOT: (&str, usize);
    /// The same of a landmark.
    const LANDMARK: (&str, usize);
}
