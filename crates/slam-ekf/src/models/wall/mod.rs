//! Walls: lines of the plane with their observed extent.

mod line;
mod sensor;
mod wall_landmark;
mod wall_measurement;

pub use line::WallLine;
pub use sensor::WallSensor;
pub use wall_landmark::Wall;
pub use wall_measurement::WallMeasurement;
