use std::f64::consts::TAU;

use crate::LineExtractionError;

/// Maximum range, m: far beyond any laser, and without overflow or loss of relevant digits.
const FARTHEST_M: f64 = 1e6;

/// The ranges of one turn of a laser: beam $`i`$ has the direction $`α_0 + i Δ`$ in the sensor's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scan<'a> {
    /// Bearing of the first beam, radians.
    pub angle_min: f64,
    /// From one beam to the next, radians; negative if they turn clockwise.
    pub angle_increment: f64,
    /// Metres. Whatever is not in (0, `max_range`] is a beam without an echo.
    pub ranges: &'a [f64],
    /// The farthest range that is an echo, metres.
    pub max_range: f64,
}

impl Scan<'_> {
    pub(super) fn check(&self) -> Result<(), LineExtractionError> {
        let refuse = |what, value, must| Err(LineExtractionError::Scan { what, value, must });
        if !self.angle_min.is_finite() {
            return refuse("angle_min (rad)", self.angle_min, "finite");
        }
        if !(self.max_range > 0.0 && self.max_range <= FARTHEST_M) {
            return refuse("max_range (m)", self.max_range, "in (0, 1e6]");
        }
        let gaps = self.ranges.len().saturating_sub(1) as f64;
        if !self.angle_increment.is_finite() || (self.angle_increment == 0.0 && gaps > 0.0) {
            return refuse("angle_increment (rad)", self.angle_increment, "finite and not zero");
        }
        // A full turn may repeat its first beam; logs round increments to four digits or so.
        if self.angle_increment.abs() * gaps > TAU * 1.001 {
            return Err(LineExtractionError::MoreThanATurn {
                n_beams: self.ranges.len(),
                increment_rad: self.angle_increment,
            });
        }
        Ok(())
    }
}
