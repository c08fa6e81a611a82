use nalgebra::Vector2;
use rand::Rng;
use wayfix_sensor_log::TrueLandmark;

use super::{CorridorLoop, OfficeFloor, RoadsideLandmarks, UniformLandmarkField, Wall};
use crate::SimulationError;
use crate::route::Route;

/// The most landmarks a layout places.
pub(super) const MOST_LANDMARKS: usize = 100_000;

/// Landmarks and walls.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct FloorPlan {
    /// Points that the robot may learn.
    pub landmarks: Vec<TrueLandmark>,
    /// Walls that hide the landmarks.
    pub walls: Vec<Wall>,
}

impl FloorPlan {
    /// Landmarks numbered from 0 in the order of `points`.
    pub fn numbered(points: Vec<Vector2<f64>>, walls: Vec<Wall>) -> Self {
        let landmarks = points.iter().zip(0..).map(|(p, id)| TrueLandmark { id, x: p.x, y: p.y }).collect();
        Self { landmarks, walls }
    }
}

/// A kind of place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorldLayout {
    /// Random landmarks in a square.
    UniformField(UniformLandmarkField),
    /// A corridor around a block.
    CorridorLoop(CorridorLoop),
    /// A corridor around a block, with rooms, doors, pillars and furniture: walls only.
    OfficeFloor(OfficeFloor),
    /// Rocks along the robot's route.
    Roadside(RoadsideLandmarks),
}

impl WorldLayout {
    /// Places landmarks and walls; `route` is where the robot is going to drive.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range, and [`SimulationError::NoRoom`] if landmarks do not fit.
    pub fn build<R: Rng + ?Sized>(&self, route: &Route, rng: &mut R) -> Result<FloorPlan, SimulationError> {
        match self {
            Self::UniformField(field) => field.plan(rng),
            Self::CorridorLoop(corridor) => corridor.plan(rng),
            Self::OfficeFloor(floor) => floor.plan(rng),
            Self::Roadside(rocks) => rocks.plan(route, rng),
        }
    }
}
