//! Walls: lines of the plane with the stretch of them that was seen.

mod line;
mod seen;
mod sensor;
mod wall_landmark;

pub use line::WallLine;
pub use seen::SeenWall;
pub use sensor::WallSensor;
pub use wall_landmark::Wall;
