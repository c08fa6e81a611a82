use std::f64::consts::FRAC_PI_2;

use wayfix_estimation_traits::Pose2;

use super::{Route, RoutePiece};
use crate::{SimulationError, check};

/// A rectangle with rounded corners about the origin, counter-clockwise from the middle of its lower side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedRectangleRoute {
    /// Extent along x, metres.
    pub length_m: f64,
    /// Extent along y, metres.
    pub width_m: f64,
    /// Radius of the corners, metres.
    pub corner_radius_m: f64,
}

impl RoundedRectangleRoute {
    /// The closed route.
    ///
    /// # Errors
    /// Returns an error if a number is not positive, or the corners do not leave straight sides.
    pub fn route(&self) -> Result<Route, SimulationError> {
        let r = self.corner_radius_m;
        check::positive("radius of the corners (m)", r)?;
        check::above(
            "length of the rectangle (m)",
            self.length_m,
            2.0 * r,
            "finite and above two corner radii",
        )?;
        check::above(
            "width of the rectangle (m)",
            self.width_m,
            2.0 * r,
            "finite and above two corner radii",
        )?;
        let straight = |length_m| RoutePiece { length_m, curvature_per_m: 0.0 };
        let corner = RoutePiece { length_m: FRAC_PI_2 * r, curvature_per_m: 1.0 / r };
        let (along, across) = (self.length_m - 2.0 * r, self.width_m - 2.0 * r);
        let pieces = vec![
            straight(0.5 * along),
            corner,
            straight(across),
            corner,
            straight(along),
            corner,
            straight(across),
            corner,
            straight(0.5 * along),
        ];
        Route::closed(Pose2::new(0.0, -0.5 * self.width_m, 0.0), pieces)
    }
}
