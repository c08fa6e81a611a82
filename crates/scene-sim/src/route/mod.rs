//! Routes of robots: connected straight lines and arcs, and planners for them.

mod circle;
mod params;
mod pieces;
mod rounded_rectangle;
mod waypoints;

pub use circle::CircleRoute;
pub use params::RouteParams;
pub use pieces::{Route, RoutePiece};
pub use rounded_rectangle::RoundedRectangleRoute;
pub use waypoints::RandomWaypointRoute;
