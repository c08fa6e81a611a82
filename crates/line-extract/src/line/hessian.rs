use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;

/// A line in Hessian form, $`x \cos α + y \sin α = ρ`$, with $`ρ \ge 0`$ (metres) and $`α`$ in (−π, π] (radians).
///
/// The normal points away from the origin, usually the sensor. A line through the origin has two normals; the given one is kept.
/// ```
/// use nalgebra::Vector2;
/// use wayfix_line_extract::HessianLine;
///
/// let wall = HessianLine::new(-2.0, 0.0); // the same as 2 m behind
/// assert_eq!((wall.rho(), wall.alpha()), (2.0, std::f64::consts::PI));
/// assert!((wall.signed_distance(&Vector2::new(-5.0, 1.0)) - 3.0).abs() < 1e-12);
/// assert!((wall.project(&Vector2::new(-5.0, 1.0)) - Vector2::new(-2.0, 1.0)).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "Raw", into = "Raw")
)]
pub struct HessianLine {
    rho: f64,
    alpha: f64,
}

impl HessianLine {
    /// The line with these parameters, brought to $`ρ \ge 0`$ and $`α`$ in (−π, π].
    pub fn new(rho: f64, alpha: f64) -> Self {
        if rho < 0.0 { Self { rho: -rho, alpha: wrap(alpha + PI) } } else { Self { rho, alpha: wrap(alpha) } }
    }

    /// Distance from the origin, metres.
    pub fn rho(&self) -> f64 {
        self.rho
    }

    /// Direction of the normal, radians.
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// The unit normal, away from the origin.
    pub fn normal(&self) -> Vector2<f64> {
        Vector2::new(self.alpha.cos(), self.alpha.sin())
    }

    /// The unit vector along the line with the origin on its left: the direction of counter-clockwise beams.
    pub fn direction(&self) -> Vector2<f64> {
        Vector2::new(-self.alpha.sin(), self.alpha.cos())
    }

    /// Metres from the line, negative on the origin's side.
    pub fn signed_distance(&self, point: &Vector2<f64>) -> f64 {
        self.normal().dot(point) - self.rho
    }

    /// The nearest point on the line.
    pub fn project(&self, point: &Vector2<f64>) -> Vector2<f64> {
        point - self.normal() * self.signed_distance(point)
    }
}

/// To (−π, π].
pub(super) fn wrap(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Raw {
    rho: f64,
    alpha: f64,
}

#[cfg(feature = "serde")]
impl From<Raw> for HessianLine {
    fn from(raw: Raw) -> Self {
        Self::new(raw.rho, raw.alpha)
    }
}

#[cfg(feature = "serde")]
impl From<HessianLine> for Raw {
    fn from(line: HessianLine) -> Self {
        Self { rho: line.rho, alpha: line.alpha }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn every_form_of_a_line_becomes_one() {
        for turns in -3..=3 {
            for (rho, alpha) in [(1.5, 0.7), (-1.5, 0.7 + PI), (-1.5, 0.7 - PI)] {
                let line = HessianLine::new(rho, alpha + TAU * f64::from(turns));
                assert_abs_diff_eq!(line.rho(), 1.5, epsilon = 1e-12);
                assert_abs_diff_eq!(line.alpha(), 0.7, epsilon = 1e-12);
            }
        }
        assert_eq!(HessianLine::new(1.0, -PI).alpha(), PI);
        assert_eq!(HessianLine::new(1.0, PI).alpha(), PI);
    }
}
