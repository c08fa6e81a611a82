use nalgebra::{Const, Matrix2, Vector2};
use wayfix_estimation_traits::Manifold;
use wayfix_line_extract::Segment;

use super::WallLine;

/// A piece of a wall as one scan shows it, in the frame of the sensor, with the covariance that its points give it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenWall {
    /// The line it is on.
    pub line: WallLine,
    /// Covariance of $`(ρ, α)`$.
    pub covariance: Matrix2<f64>,
    /// Its ends, metres.
    pub ends: [Vector2<f64>; 2],
}

impl From<&Segment> for SeenWall {
    fn from(segment: &Segment) -> Self {
        let found = segment.estimate.line;
        Self {
            line: WallLine::new(found.rho(), found.alpha()),
            covariance: segment.estimate.covariance,
            ends: [segment.start, segment.end],
        }
    }
}

impl SeenWall {
    /// How far the two pieces overlap along this one, metres; negative for a gap between them.
    pub fn overlap(&self, other: &Self) -> f64 {
        let stretch = |piece: &Self| {
            let [a, b] = piece.ends.map(|end| self.line.along(&end));
            (a.min(b), a.max(b))
        };
        let (own, others) = (stretch(self), stretch(other));
        own.1.min(others.1) - own.0.max(others.0)
    }
}

impl Manifold for SeenWall {
    type Scalar = f64;
    type Dim = Const<2>;
    fn dim(&self) -> Const<2> {
        Const
    }
    fn retract(&self, delta: &Vector2<f64>) -> Self {
        Self { line: self.line.retract(delta), ..*self }
    }
    fn local(&self, other: &Self) -> Vector2<f64> {
        self.line.local(&other.line)
    }
}
