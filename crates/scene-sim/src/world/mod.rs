//! Visible objects: landmarks, walls that hide them, other robots, objects with unlisted codes.

mod corridor;
mod field;
mod layout;
mod office_floor;
mod planar;
mod roadside;
mod wall;

pub use corridor::CorridorLoop;
pub use field::UniformLandmarkField;
pub use layout::{FloorPlan, WorldLayout};
pub use office_floor::OfficeFloor;
pub use planar::{OtherRobot, PlanarWorld, SensorWorld};
pub use roadside::RoadsideLandmarks;
pub use wall::Wall;
