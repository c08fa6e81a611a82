use nalgebra::{DefaultAllocator, Matrix3};
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_ekf::{
    LandmarkDim, LandmarkModel, MapMeasurement, MeasurementDim, PlanarRobot, RobotDim, SlamAlloc, SlamError,
};
use wayfix_system_core::HeadingSignTest;

use super::SlamEstimator;

/// What EKF-SLAM remembers of external sensors between two records.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ExternalState {
    /// Stamp of the last increment, nanoseconds; measurements after it wait.
    pub last_increment: Option<u64>,
    /// Measurements that wait for the increment that leads beyond them: nanoseconds, and what was measured.
    pub waiting: Vec<(u64, MapMeasurement)>,
    /// Logarithm of the odds that the compass is mirrored.
    pub mirrored_compass_log_odds: f64,
}

impl<M: LandmarkModel<Robot: PlanarRobot>> SlamEstimator<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Corrects robot and map by a measurement that was made after a motion from the filter's state. An outlier is counted, and a heading as long as its sign
    /// is unknown or wrong.
    pub(super) fn update_moved(
        &mut self,
        measurement: &MapMeasurement,
        motion: Pose2<f64>,
        covariance: Matrix3<f64>,
        heading_sign: &mut HeadingSignTest,
    ) -> Result<(), String> {
        if let MapMeasurement::Heading(sensor, measured) = measurement {
            let predicted = self.filter.robot().pose().compose(&motion).heading();
            let variance = self.filter.robot_covariance()[(2, 2)] + covariance.m33 + sensor.variance;
            if !heading_sign.is_admitted(measured.radians(), predicted, variance, &mut self.events) {
                return Ok(());
            }
        }
        let before = *self.filter.robot().pose();
        match self.filter.update_moved(measurement, motion, covariance) {
            Ok(innovation) => {
                self.record_robot(&innovation.jacobian, &innovation.covariance);
                if let Some(follower) = &mut self.follower {
                    let measurement = measurement.with_motion_noise(&before, motion, covariance);
                    follower.measured(&self.filter, &measurement, motion);
                }
                self.events.count("measurement_accepted");
            }
            Err(outlier @ SlamError::Outlier { .. }) => {
                self.events.refuse("measurement_gated", format!("a measured pose is {outlier}"));
            }
            Err(error) => return Err(error.to_string()),
        }
        Ok(())
    }
}
