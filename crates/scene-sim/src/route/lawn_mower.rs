use std::f64::consts::FRAC_PI_2;

use wayfix_estimation_traits::Pose2;

use super::{Route, RoutePiece};
use crate::{SimulationError, check};

/// Parallel rows there and back, joined by half circles; starts at the lower left, centred on the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawnMowerRoute {
    /// Number of rows, 1 to 100 000.
    pub n_rows: usize,
    /// Straight part of each row, metres.
    pub row_length_m: f64,
    /// Distance between rows, metres; turns have half of it as radius.
    pub spacing_m: f64,
}

impl LawnMowerRoute {
    /// The open route.
    ///
    /// # Errors
    /// Returns an error if there is no row or too many, or a length is not a positive number.
    pub fn route(&self) -> Result<Route, SimulationError> {
        check::count("rows of the lawn-mower", self.n_rows, 100_000)?;
        check::positive("length of a row (m)", self.row_length_m)?;
        check::positive("spacing of the rows (m)", self.spacing_m)?;
        let row = RoutePiece { length_m: self.row_length_m, curvature_per_m: 0.0 };
        let mut pieces = Vec::with_capacity(2 * self.n_rows);
        for idx in 0..self.n_rows {
            if idx > 0 {
                let side = if idx % 2 == 1 { 1.0 } else { -1.0 };
                pieces.push(RoutePiece {
                    length_m: FRAC_PI_2 * self.spacing_m,
                    curvature_per_m: side * 2.0 / self.spacing_m,
                });
            }
            pieces.push(row);
        }
        let lowest = -0.5 * self.spacing_m * self.n_rows.saturating_sub(1) as f64;
        Route::open(Pose2::new(-0.5 * self.row_length_m, lowest, 0.0), pieces)
    }
}
