use nalgebra::{DefaultAllocator, Matrix3, Vector2};
use wayfix_estimation_traits::{Angle, Pose2};
use wayfix_sensor_log::{MeasuredQuantity, PoseMeasurement};
use wayfix_slam_ekf::{
    ExternalError, ExternalParams, HeadingSensor, LandmarkDim, LandmarkModel, MeasurementDim, MovedSensor,
    PlanarRobot, PoseSensor, PositionSensor, RobotDim, SlamAlloc, SlamError,
};

use super::SlamEstimator;

/// A measurement of the pose in the frame of the map, with its sensor.
pub(super) enum MapMeasurement {
    Position(PositionSensor, Vector2<f64>),
    Heading(HeadingSensor, Angle<f64>),
    Pose(PoseSensor, Pose2<f64>),
}

impl MapMeasurement {
    /// # Errors
    /// Returns an error if the frame, the datum or the covariance is unknown.
    pub(super) fn new(
        measured: &PoseMeasurement,
        params: &ExternalParams,
        antenna: Vector2<f64>,
    ) -> Result<Self, ExternalError> {
        let covariance = |position, heading| params.covariance(measured.covariance, position, heading);
        let position = |position| {
            let covariance = covariance(true, false)?.fixed_view::<2, 2>(0, 0).into_owned();
            Ok(Self::Position(PositionSensor { antenna, covariance }, position))
        };
        if let MeasuredQuantity::Geodetic { latitude, longitude } = measured.quantity {
            return position(params.position(latitude, longitude)?);
        }
        params.check_frame(&measured.frame)?;
        match measured.quantity {
            MeasuredQuantity::Heading(heading) => {
                let variance = covariance(false, true)?.m33;
                Ok(Self::Heading(HeadingSensor { variance }, Angle::new(heading)))
            }
            MeasuredQuantity::Pose(pose) => {
                Ok(Self::Pose(PoseSensor { covariance: covariance(true, true)? }, pose))
            }
            MeasuredQuantity::Position(at) => position(at),
            MeasuredQuantity::Geodetic { .. } => Err(ExternalError::Datum),
        }
    }
}

impl<M: LandmarkModel<Robot: PlanarRobot>> SlamEstimator<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Corrects robot and map by a measurement of the pose, made after `motion` from the filter's state. An outlier is counted.
    pub(super) fn take_measurement(
        &mut self,
        measurement: &MapMeasurement,
        (motion, covariance): (Pose2<f64>, Matrix3<f64>),
    ) -> Result<(), ExternalError> {
        let updated = match *measurement {
            MapMeasurement::Position(sensor, at) => {
                self.filter.update_pose(&MovedSensor { sensor, motion, covariance }, &at)
            }
            MapMeasurement::Heading(sensor, heading) => {
                self.filter.update_pose(&MovedSensor { sensor, motion, covariance }, &heading)
            }
            MapMeasurement::Pose(sensor, pose) => {
                self.filter.update_pose(&MovedSensor { sensor, motion, covariance }, &pose)
            }
        };
        match updated {
            Ok(innovation) => {
                self.record_robot(&innovation.jacobian, &innovation.covariance);
                self.events.count("measurement_accepted");
            }
            Err(outlier @ SlamError::Outlier { .. }) => {
                self.events.refuse("measurement_gated", format!("a measured pose is {outlier}"));
            }
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }
}
