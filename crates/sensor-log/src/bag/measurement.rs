use nalgebra::Matrix3;
use wayfix_estimation_traits::{Pose2, Pose3};

use crate::fault::{Fault, finite, inconsistent, spatial};
use crate::planar::heading_of;
use crate::ros::{Imu, NavSatFix};
use crate::{MeasuredQuantity, PoseMeasurement, RecordData};

/// A fix of a receiver.
pub(super) fn position(fix: &NavSatFix<'_>) -> Result<RecordData, Fault> {
    let NavSatFix { status, latitude, longitude, covariance, covariance_type, .. } = *fix;
    if status < 0 {
        return Err(inconsistent("the receiver has no fix"));
    }
    finite([latitude, longitude])?;
    if latitude.abs() > 90.0 || longitude.abs() > 180.0 {
        return Err(inconsistent(&format!("latitude {latitude:.3e}°, longitude {longitude:.3e}°")));
    }
    let [xx, xy, _, yx, yy, ..] = covariance;
    let covariance = Matrix3::new(xx, xy, 0.0, yx, yy, 0.0, 0.0, 0.0, 0.0);
    let quantity = MeasuredQuantity::Geodetic { latitude, longitude };
    measured("wgs84", quantity, covariance, covariance_type != 0)
}

/// The heading of the robot by an IMU that is mounted on it.
pub(super) fn heading(imu: &Imu<'_>, mount: Option<&Pose3<f64>>) -> Result<RecordData, Fault> {
    if imu.covariance[0] == -1.0 {
        return Err(inconsistent("the IMU gives no orientation"));
    }
    let orientation = spatial([0.0; 3], imu.orientation)?.rotation;
    let robot = mount.map_or(orientation, |mount| orientation * mount.rotation.inverse());
    let [i, j, k, w] = [robot.i, robot.j, robot.k, robot.w];
    let covariance = Matrix3::from_diagonal(&[0.0, 0.0, imu.covariance[8]].into());
    measured(
        PoseMeasurement::EAST_NORTH,
        MeasuredQuantity::Heading(heading_of([i, j, k, w])),
        covariance,
        true,
    )
}

/// A pose by a camera that sees the robot; `covariance` is of `(x, y, θ)`, row by row.
pub(super) fn pose(frame: &str, pose: Pose2<f64>, covariance: &[f64; 9]) -> Result<RecordData, Fault> {
    measured(frame, MeasuredQuantity::Pose(pose), Matrix3::from_row_slice(covariance), true)
}

/// In ROS messages a covariance of zeros is an unknown one.
fn measured(
    frame: &str,
    quantity: MeasuredQuantity,
    covariance: Matrix3<f64>,
    is_known: bool,
) -> Result<RecordData, Fault> {
    let covariance = Some(covariance).filter(|covariance| is_known && *covariance != Matrix3::zeros());
    finite(covariance.iter().flatten().copied())?;
    let frame = frame.strip_prefix('/').unwrap_or(frame).to_owned();
    Ok(RecordData::PoseMeasurement(PoseMeasurement { frame, quantity, covariance }))
}
