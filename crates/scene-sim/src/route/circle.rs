use std::f64::consts::PI;

use wayfix_estimation_traits::Pose2;

use super::{Route, RoutePiece};
use crate::{SimulationError, check};

/// A circle about the origin, counter-clockwise from its lowest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircleRoute {
    /// Radius, metres.
    pub radius_m: f64,
}

impl CircleRoute {
    /// The closed route.
    ///
    /// # Errors
    /// Returns an error if the radius is not a positive number.
    pub fn route(&self) -> Result<Route, SimulationError> {
        let r = self.radius_m;
        check::positive("radius of the circle (m)", r)?;
        // Two halves: the pose at the seam is then computed from nearby.
        let half = RoutePiece { length_m: PI * r, curvature_per_m: 1.0 / r };
        Route::closed(Pose2::new(0.0, -r, 0.0), vec![half, half])
    }
}
