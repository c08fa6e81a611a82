use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector2;
use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::{Route, RoutePiece};
use crate::random::deviate::uniform;
use crate::{SimulationError, check, plane};

/// Draws per waypoint before the square counts as too small for the turning circle.
const ATTEMPTS: usize = 1000;

/// From one random point of a square to the next, each time an arc and then a straight line.
///
/// Curvature is 0 or ± 1/radius; turns reach at most two radii beyond the square. Starts at the origin along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomWaypointRoute {
    /// Number of points to visit, 1 to 100 000.
    pub n_waypoints: usize,
    /// Half the side of the square, metres.
    pub half_width_m: f64,
    /// Radius of every turn, metres.
    pub turn_radius_m: f64,
}

impl RandomWaypointRoute {
    /// The open route.
    ///
    /// # Errors
    /// Returns an error if a number is out of range, or points outside the turning circle are not found in the square.
    pub fn route<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Route, SimulationError> {
        check::count("waypoints", self.n_waypoints, 100_000)?;
        check::positive("half width of the waypoints (m)", self.half_width_m)?;
        check::positive("turning radius (m)", self.turn_radius_m)?;
        let start = Pose2::new(0.0, 0.0, 0.0);
        let (mut pose, mut pieces) = (start, Vec::with_capacity(2 * self.n_waypoints));
        for placed in 0..self.n_waypoints {
            let wanted = self.n_waypoints;
            let (turn, straight) = (0..ATTEMPTS)
                .find_map(|_| turn_and_go(&pose, &self.draw(rng), self.turn_radius_m))
                .ok_or(SimulationError::NoRoom { what: "waypoints", placed, wanted })?;
            for piece in [turn, straight].into_iter().filter(|piece| piece.length_m > 0.0) {
                pose = plane::advance(&pose, piece.length_m, piece.length_m * piece.curvature_per_m);
                pieces.push(piece);
            }
        }
        Route::open(start, pieces)
    }

    fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> Vector2<f64> {
        let mut coordinate = || uniform(-self.half_width_m, self.half_width_m, rng);
        Vector2::new(coordinate(), coordinate())
    }
}

/// The arc that turns towards `point` and the following straight line; `None` if the point lies inside the turning circle.
fn turn_and_go(pose: &Pose2<f64>, point: &Vector2<f64>, radius: f64) -> Option<(RoutePiece, RoutePiece)> {
    let seen = plane::to_body(pose, point);
    let side = if seen.y < 0.0 { -1.0 } else { 1.0 };
    // Mirrored to a left turn about (0, radius).
    let from_centre = Vector2::new(seen.x, seen.y.abs() - radius);
    let straight_squared = from_centre.norm_squared() - radius * radius;
    if straight_squared <= 0.0 {
        return None;
    }
    let straight = straight_squared.sqrt();
    let angle = libm::atan2(from_centre.y, from_centre.x) + FRAC_PI_2 - libm::atan2(straight, radius);
    let turn = RoutePiece { length_m: radius * angle.rem_euclid(TAU), curvature_per_m: side / radius };
    Some((turn, RoutePiece { length_m: straight, curvature_per_m: 0.0 }))
}
