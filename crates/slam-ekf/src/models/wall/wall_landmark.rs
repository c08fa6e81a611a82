use nalgebra::{Const, Vector2};
use wayfix_estimation_traits::Manifold;

use super::WallLine;

/// A wall of the map: the line is estimated, the stretch of it that was seen is kept beside.
///
/// The line is given about a point of its own, the middle of what was seen first. About the origin of the world an error of the direction
/// would move a wall by its distance from there, and estimates would depend on where the origin is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Wall {
    /// The point that the line is given about, in world coordinates; it is not estimated.
    pub origin: Vector2<f64>,
    /// The line about that point, along the axes of the world.
    pub line: WallLine,
    /// From where to where along the line it was seen, metres from the foot of the perpendicular from that point; ascending.
    pub stretch: [f64; 2],
}

impl Wall {
    /// The wall on a line, in world coordinates, between the projections of two points.
    pub fn between(line: WallLine, ends: [Vector2<f64>; 2]) -> Self {
        let origin = (ends[0] + ends[1]) * 0.5;
        Self::about(origin, line.about(&origin), ends)
    }
    /// The wall on a line that is given about a point, between the projections of two points of the world.
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
    /// The same wall, reaching as far as these points.
    pub fn extended_to(&self, points: [Vector2<f64>; 2]) -> Self {
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
    /// Both lines about the point of this one.
    fn local(&self, other: &Self) -> Vector2<f64> {
        self.line.local(&other.line.about(&(self.origin - other.origin)))
    }
}
