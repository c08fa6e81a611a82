//! Measurements of the pose as point clouds, and back.

use foxglove::messages::packed_element_field::NumericType::Float64;
use foxglove::messages::{PointCloud, Timestamp};
use nalgebra::{Matrix3, Vector2};
use wayfix_estimation_traits::Pose2;

use super::cloud::{self, Column};
use super::reading::decode::{decode, point_fields, read_points, stamp};
use crate::fault::{Fault, inconsistent};
use crate::{MeasuredQuantity, PoseMeasurement, Record, RecordData, Stamp};

/// A viewer draws a point at x, y; of a geodetic position these are longitude and latitude. `z` is zero.
const NAMES: [&str; 12] =
    ["x", "y", "z", "heading", "xx", "xy", "yy", "xh", "yh", "hh", "has_covariance", "kind"];

pub(super) fn encode(timestamp: Timestamp, measurement: &PoseMeasurement) -> PointCloud {
    let (kind, [x, y, heading]) = match measurement.quantity {
        MeasuredQuantity::Position(position) => (0.0, [position.x, position.y, 0.0]),
        MeasuredQuantity::Geodetic { latitude, longitude } => (1.0, [longitude, latitude, 0.0]),
        MeasuredQuantity::Heading(heading) => (2.0, [0.0, 0.0, heading]),
        MeasuredQuantity::Pose(pose) => (3.0, [pose.x(), pose.y(), pose.heading()]),
    };
    let c = measurement.covariance.unwrap_or_else(Matrix3::zeros);
    let has_covariance = if measurement.covariance.is_some() { 1.0 } else { 0.0 };
    let columns: [Column; 12] = NAMES.map(|name| (name, Float64));
    let numbers = [x, y, 0.0, heading, c.m11, c.m12, c.m22, c.m13, c.m23, c.m33, has_covariance, kind];
    cloud::pack(timestamp, &measurement.frame, &columns, &[numbers], |numbers, data| {
        data.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    })
}

pub(super) fn measurement(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let cloud: PointCloud = decode(bytes)?;
    let stamp = stamp(cloud.timestamp, log_time)?;
    let fields = point_fields(&cloud, NAMES)?;
    let read = |point: &[u8]| {
        let numbers: Option<Vec<f64>> = fields.iter().map(|field| field.float(point)).collect();
        let [x, y, _, heading, xx, xy, yy, xh, yh, hh, has_covariance, kind] =
            <[f64; 12]>::try_from(numbers?).ok()?;
        let quantity = match kind as u32 {
            0 => MeasuredQuantity::Position(Vector2::new(x, y)),
            1 => MeasuredQuantity::Geodetic { latitude: y, longitude: x },
            2 => MeasuredQuantity::Heading(heading),
            3 => MeasuredQuantity::Pose(Pose2::new(x, y, heading)),
            _ => return None,
        };
        let covariance = Matrix3::new(xx, xy, xh, xy, yy, yh, xh, yh, hh);
        let covariance = (has_covariance != 0.0).then_some(covariance);
        Some(RecordData::PoseMeasurement(PoseMeasurement {
            frame: cloud.frame_id.clone(),
            quantity,
            covariance,
        }))
    };
    let measurements = read_points(&cloud, read)?;
    let finite = measurements.iter().try_for_each(RecordData::check_finite);
    finite.map_err(|what| inconsistent(&format!("{what} that is not finite")))?;
    Ok(measurements.into_iter().map(|data| Record { stamp, data }).collect())
}
