use rand::Rng;

use super::{CircleRoute, RandomWaypointRoute, RoundedRectangleRoute, Route};
use crate::SimulationError;

/// Parameters of a route.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::route::{RouteParams, RandomWaypointRoute};
/// let params = RandomWaypointRoute { n_waypoints: 20, half_width_m: 5.0, turn_radius_m: 0.5 };
/// let route = RouteParams::Waypoints(params).build(&mut ChaCha8Rng::seed_from_u64(1))?;
/// assert!(!route.is_closed() && route.length_m() > 20.0);
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RouteParams {
    /// Around a circle.
    Circle(CircleRoute),
    /// Around a rectangle.
    RoundedRectangle(RoundedRectangleRoute),
    /// From one random point to the next.
    Waypoints(RandomWaypointRoute),
}

impl RouteParams {
    /// Lays out the route; only random ones draw from `rng`.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range, and [`SimulationError::NoRoom`] if waypoints do not fit.
    pub fn build<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Route, SimulationError> {
        match self {
            Self::Circle(circle) => circle.route(),
            Self::RoundedRectangle(rectangle) => rectangle.route(),
            Self::Waypoints(waypoints) => waypoints.route(rng),
        }
    }
}
