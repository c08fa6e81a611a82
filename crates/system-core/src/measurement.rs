use nalgebra::Vector2;
use wayfix_estimation_traits::Angle;
use wayfix_sensor_log::{MeasuredQuantity, PoseMeasurement};
use wayfix_slam_ekf::{
    ExternalError, ExternalParams, HeadingSensor, MapMeasurement, PoseSensor, PositionSensor,
};

/// A measured pose in the frame of the map.
///
/// # Errors
/// Returns an error if the frame, the datum or the covariance is unknown.
pub fn map_measurement(
    measured: &PoseMeasurement,
    params: &ExternalParams,
    antenna: Vector2<f64>,
) -> Result<MapMeasurement, ExternalError> {
    let covariance = |position, heading| params.covariance(measured.covariance, position, heading);
    let at = |position| {
        let covariance = covariance(true, false)?.fixed_view::<2, 2>(0, 0).into_owned();
        Ok(MapMeasurement::Position(PositionSensor { antenna, covariance }, position))
    };
    if let MeasuredQuantity::Geodetic { latitude, longitude } = measured.quantity {
        return at(params.position(latitude, longitude)?);
    }
    params.check_frame(&measured.frame)?;
    match measured.quantity {
        MeasuredQuantity::Geodetic { .. } => Err(ExternalError::Datum),
        MeasuredQuantity::Position(position) => at(position),
        MeasuredQuantity::Heading(heading) => {
            let variance = covariance(false, true)?.m33;
            Ok(MapMeasurement::Heading(HeadingSensor { variance }, Angle::new(heading)))
        }
        MeasuredQuantity::Pose(pose) => {
            Ok(MapMeasurement::Pose(PoseSensor { covariance: covariance(true, true)? }, pose))
        }
    }
}
