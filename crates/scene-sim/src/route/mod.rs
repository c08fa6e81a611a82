//! Routes of robots: connected straight lines and arcs, and planners for them.

mod circle;
mod lawn_mower;
mod params;
mod pieces;
mod rounded_rectangle;
mod waypoints;

pub use circle::Circle;
pub use lawn_mower::LawnMower;
pub use params::RouteParams;
pub use pieces::{Piece, Route};
pub use rounded_rectangle::RoundedRectangle;
pub use waypoints::Waypoints;
