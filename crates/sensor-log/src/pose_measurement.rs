use nalgebra::{Matrix3, Vector2};
use wayfix_estimation_traits::Pose2;

/// A measurement of the robot's pose, or a part of it, by a sensor that does not use the map: a receiver, a compass, a camera at the ceiling.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseMeasurement {
    /// The frame that the values are given in; [`EAST_NORTH`](Self::EAST_NORTH) for headings against east.
    pub frame: String,
    /// The values.
    pub quantity: MeasuredQuantity,
    /// Covariance of `(x, y, θ)` in the axes of the frame, m and rad; zero where nothing is measured. `None` if the sensor states none.
    pub covariance: Option<Matrix3<f64>>,
}

/// What a [`PoseMeasurement`] measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeasuredQuantity {
    /// Position of the antenna or another point of the robot, m.
    Position(Vector2<f64>),
    /// The same in WGS 84, degrees. The axes of its covariance are east and north.
    Geodetic {
        /// North is positive.
        latitude: f64,
        /// East is positive.
        longitude: f64,
    },
    /// Heading, rad, counter-clockwise from the x axis of the frame.
    Heading(f64),
    /// Position and heading of the robot.
    Pose(Pose2<f64>),
}

impl PoseMeasurement {
    /// The name of a frame whose x axis points east and whose y axis points north. [REP 103]
    pub const EAST_NORTH: &str = "enu";

    pub(crate) fn is_finite(&self) -> bool {
        let values = match &self.quantity {
            MeasuredQuantity::Position(position) => position.iter().all(|value| value.is_finite()),
            MeasuredQuantity::Geodetic { latitude, longitude } => {
                latitude.is_finite() && longitude.is_finite()
            }
            MeasuredQuantity::Heading(heading) => heading.is_finite(),
            MeasuredQuantity::Pose(pose) => pose.is_finite(),
        };
        values && self.covariance.iter().flatten().all(|entry| entry.is_finite())
    }
}
