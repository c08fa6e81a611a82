use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector2;
use rand::Rng;

use super::{FloorPlan, layout::MOST_LANDMARKS};
use crate::random::deviate::{chance, uniform};
use crate::route::Route;
use crate::{SimulationError, check, plane};

/// Rocks on both sides of whatever road the robot takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoadsideLandmarks {
    /// Number of rocks, at random places along the route.
    pub n_landmarks: usize,
    /// The least distance from the middle of the road, metres.
    pub clear_m: f64,
    /// Width of the strip beyond it that may contain rocks, m.
    pub verge_m: f64,
}

impl RoadsideLandmarks {
    /// Places the rocks along `route`.
    ///
    /// # Errors
    /// Returns an error if a number is out of range.
    pub fn plan<R: Rng + ?Sized>(&self, route: &Route, rng: &mut R) -> Result<FloorPlan, SimulationError> {
        check::count("landmarks", self.n_landmarks, MOST_LANDMARKS)?;
        check::not_negative("clear width of the road (m)", self.clear_m)?;
        check::positive("width of the verge (m)", self.verge_m)?;
        let points = (0..self.n_landmarks).map(|_| self.rock(route, rng)).collect();
        Ok(FloorPlan::numbered(points, Vec::new()))
    }

    fn rock<R: Rng + ?Sized>(&self, route: &Route, rng: &mut R) -> Vector2<f64> {
        let road = route.at(uniform(0.0, route.length_m(), rng));
        let side = if chance(0.5, rng) { FRAC_PI_2 } else { -FRAC_PI_2 };
        let away = self.clear_m + uniform(0.0, self.verge_m, rng);
        road.translation + plane::direction(road.heading() + side) * away
    }
}
