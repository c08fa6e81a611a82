use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Const, Vector2};
use wayfix_estimation_traits::{Manifold, wrap_angle};

/// A line of the plane, $`x \cos α + y \sin α = ρ`$, as a point of a manifold: $`(ρ, α)`$ and $`(-ρ, α + π)`$ are the same line.
///
/// ρ has a sign, so a line may pass through the origin while it is estimated. [`local`](Manifold::local) uses the nearer of the two forms,
/// so a wall can be observed from either side and across the wrap of α.
///
/// ```
/// use wayfix_estimation_traits::Manifold;
/// use wayfix_slam_ekf::WallLine;
/// let (one, same) = (WallLine::new(0.02, 0.1), WallLine::new(-0.02, 0.1 - std::f64::consts::PI));
/// assert!(one.local(&same).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WallLine {
    /// Distance from the origin along the normal, metres; negative when the normal points towards the origin.
    pub rho: f64,
    /// Direction of the normal, radians in (−π, π].
    pub alpha: f64,
}

impl WallLine {
    /// The line with these parameters; α is wrapped.
    pub fn new(rho: f64, alpha: f64) -> Self {
        Self { rho, alpha: wrap_angle(alpha) }
    }
    /// The same line relative to another point, given relative to the current one.
    pub fn about(&self, point: &Vector2<f64>) -> Self {
        Self { rho: self.rho - self.normal().dot(point), ..*self }
    }
    /// The unit normal.
    pub fn normal(&self) -> Vector2<f64> {
        let (sin, cos) = self.alpha.sin_cos();
        Vector2::new(cos, sin)
    }
    /// The unit vector along the line, a quarter turn to the left of the normal.
    pub fn direction(&self) -> Vector2<f64> {
        let normal = self.normal();
        Vector2::new(-normal.y, normal.x)
    }
    /// The point at `along` metres from the foot of the perpendicular from the origin.
    pub fn point_at(&self, along: f64) -> Vector2<f64> {
        self.normal() * self.rho + self.direction() * along
    }
    /// Position of the nearest point of the line, metres from the foot of the perpendicular.
    pub fn along(&self, point: &Vector2<f64>) -> f64 {
        self.direction().dot(point)
    }
}

impl WallLine {
    /// Whether the normals of both point to the same side, so that [`local`](Manifold::local) compares both lines as they are.
    pub fn normal_agrees_with(&self, other: &Self) -> bool {
        wrap_angle(other.alpha - self.alpha).abs() <= FRAC_PI_2
    }
}

impl Manifold for WallLine {
    type Scalar = f64;
    type Dim = Const<2>;
    fn dim(&self) -> Const<2> {
        Const
    }
    fn retract(&self, delta: &Vector2<f64>) -> Self {
        Self::new(self.rho + delta.x, self.alpha + delta.y)
    }
    fn local(&self, other: &Self) -> Vector2<f64> {
        let turn = wrap_angle(other.alpha - self.alpha);
        if self.normal_agrees_with(other) {
            Vector2::new(other.rho - self.rho, turn)
        } else {
            Vector2::new(-other.rho - self.rho, wrap_angle(turn + PI))
        }
    }
}
