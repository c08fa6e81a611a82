use nalgebra::Vector2;
use rand::Rng;

use super::{FloorPlan, Wall, layout::MOST_LANDMARKS};
use crate::random::deviate::uniform;
use crate::{SimulationError, check};

/// A corridor around a rectangular block about the origin; landmarks hang on both walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorridorLoop {
    /// Extent of the corridor's centre line along x, metres.
    pub length_m: f64,
    /// Extent of the centre line along y, metres.
    pub width_m: f64,
    /// Distance between the walls, metres.
    pub corridor_m: f64,
    /// Mean distance between landmarks along each wall, metres.
    pub spacing_m: f64,
}

impl CorridorLoop {
    /// Places walls and landmarks.
    ///
    /// # Errors
    /// Returns an error if a number is not positive, the corridor leaves no block inside, or there are too many landmarks.
    pub fn plan<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<FloorPlan, SimulationError> {
        check::positive("width of the corridor (m)", self.corridor_m)?;
        check::positive("spacing of the landmarks (m)", self.spacing_m)?;
        let must = "finite and above the width of the corridor";
        check::above("length of the corridor loop (m)", self.length_m, self.corridor_m, must)?;
        check::above("width of the corridor loop (m)", self.width_m, self.corridor_m, must)?;
        let n_about = 4.0 * (self.length_m + self.width_m) / self.spacing_m;
        check::count("landmarks", n_about as usize, MOST_LANDMARKS)?;
        let outer = Wall::rectangle(self.length_m + self.corridor_m, self.width_m + self.corridor_m);
        let inner = Wall::rectangle(self.length_m - self.corridor_m, self.width_m - self.corridor_m);
        let walls: Vec<Wall> = outer.into_iter().chain(inner).collect();
        let points = walls.iter().flat_map(|wall| self.hang(wall, rng)).collect();
        Ok(FloorPlan::numbered(points, walls))
    }

    /// One landmark in each section of `spacing_m`, at a random place in its middle half.
    fn hang<R: Rng + ?Sized>(&self, wall: &Wall, rng: &mut R) -> Vec<Vector2<f64>> {
        let whole = wall.to - wall.from;
        let n_stretches = (whole.norm() / self.spacing_m).round().max(1.0) as usize;
        (0..n_stretches)
            .map(|k| wall.from + whole * ((k as f64 + uniform(0.25, 0.75, rng)) / n_stretches as f64))
            .collect()
    }
}
