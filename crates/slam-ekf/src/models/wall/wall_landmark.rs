use nalgebra::{Const, Vector2};
use wayfix_estimation_traits::Manifold;

use super::WallLine;

/// A wall of the map: the line is estimated, the stretch of it that was seen is kept beside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Wall {
    /// The line, in world coordinates.
    pub line: WallLine,
    /// From where to where along the line it was seen, metres from the foot of the perpendicular from the origin; ascending.
    pub stretch: [f64; 2],
}

impl Wall {
    /// The wall on a line between the projections of two points.
    pub fn between(line: WallLine, ends: [Vector2<f64>; 2]) -> Self {
        let [a, b] = ends.map(|end| line.along(&end));
        Self { line, stretch: [a.min(b), a.max(b)] }
    }
    /// Its ends in world coordinates, metres.
    pub fn ends(&self) -> [Vector2<f64>; 2] {
        self.stretch.map(|along| self.line.point_at(along))
    }
    /// The same wall, reaching as far as these points.
    pub fn extended_to(&self, points: [Vector2<f64>; 2]) -> Self {
        let [low, high] = self.stretch;
        let [a, b] = points.map(|point| self.line.along(&point));
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
        Self::between(self.line.retract(delta), self.ends())
    }
    fn local(&self, other: &Self) -> Vector2<f64> {
        self.line.local(&other.line)
    }
}
