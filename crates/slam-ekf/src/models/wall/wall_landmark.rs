use nalgebra::{Const, Vector2};
use wayfix_estimation_traits::Manifold;

use super::WallLine;

/// A wall of the map: its line is estimated, its observed extent is stored.
///
/// The line is relative to its own reference point, the middle of the first observation. Relative to the world origin, an error of the direction
/// would move a wall in proportion to its distance from there, and estimates would depend on the choice of the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Wall {
    /// The reference point of the line, in world coordinates; it is not estimated.
    pub origin: Vector2<f64>,
    /// The line relative to that point, with the axes of the world.
    pub line: WallLine,
    /// Observed extent along the line, metres from the foot of the perpendicular from that point; ascending.
    pub stretch: [f64; 2],
}

impl Wall {
    /// The wall on a line, in world coordinates, between the projections of two points.
    pub fn between(line: WallLine, ends: [Vector2<f64>; 2]) -> Self {
        let origin = (ends[0] + ends[1]) * 0.5;
        Self::about(origin, line.about(&origin), ends)
    }
    /// The wall on a line relative to `origin`, between the projections of two points of the world.
    pub fn about(origin: Vector2<f64>, line: WallLine, ends: [Vector2<f64>; 2]) -> Self {
        let [a, b] = ends.map(|end| line.along(&(end - origin)));
        Self { origin, line, stretch: [a.min(b), a.max(b)] }
    }
    /// The line in world coordinates.
    pub fn world_line(&self) -> WallLine {
        self.line.about(&-self.origin)
    }
    /// Its ends in world coordinates, metres.
    pub fn ends(&self) -> [Vector2<f64>; 2] {
        self.stretch.map(|along| self.origin + self.line.point_at(along))
    }
    /// The same wall, extended to these points.
    pub(crate) fn extended_to(&self, points: [Vector2<f64>; 2]) -> Self {
        let [low, high] = self.stretch;
        let [a, b] = points.map(|point| self.line.along(&(point - self.origin)));
        Self { stretch: [low.min(a.min(b)), high.max(a.max(b))], ..*self }
    }
}

impl Manifold for Wall {
    type Scalar = f64;
    type Dim = Const<2>;
    fn dim(&self) -> Const<2> {
        Const
    }
    /// The ends go to the nearest points of the new line: they do not slide when it turns.
    fn retract(&self, delta: &Vector2<f64>) -> Self {
        Self::about(self.origin, self.line.retract(delta), self.ends())
    }
    /// Both lines relative to the reference point of this one.
    fn local(&self, other: &Self) -> Vector2<f64> {
        self.line.local(&other.line.about(&(self.origin - other.origin)))
    }
}
