//! Sensors of the pose that do not depend on the map: receivers, compasses, cameras at the ceiling. [Andrade-Cetto 2005, Eqs. 23, 26, 27]
//!
//! They measure a [`Pose2`](wayfix_estimation_traits::Pose2), so a filter and a smoother take the same ones.

mod heading_sensor;
mod local_plane;
mod map_measurement;
mod moved_sensor;
mod params;
mod planar_robot;
mod pose_sensor;
mod position_sensor;

pub use heading_sensor::HeadingSensor;
pub use local_plane::LocalPlane;
pub use map_measurement::MapMeasurement;
pub use moved_sensor::MovedSensor;
pub use params::{ExternalError, ExternalParams};
pub use planar_robot::PlanarRobot;
pub use pose_sensor::PoseSensor;
pub use position_sensor::PositionSensor;
