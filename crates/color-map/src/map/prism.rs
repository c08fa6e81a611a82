use nalgebra::Vector3;

use super::Plane;
use crate::{ColorId, PostBand};

/// Number of sides of the prism that approximates a post.
pub(crate) const SIDES: usize = 16;
/// Ratio of circumscribed to nominal radius, π / (16 sin π/16): the prism's perimeter equals that of the circle, so its mean width over
/// all directions is the circle's diameter (Cauchy).
const CORNER_RADIUS: f64 = 1.006_454_542_799_564;
/// cos π/8, cos π/4 and cos 3π/8.
const COSINES: [f64; 3] =
    [0.923_879_532_511_286_7, std::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_84];

/// A band of a post as the solid that is drawn and cast at: a regular upright prism.
#[derive(Clone, Debug)]
pub(crate) struct Prism {
    pub(crate) shape: usize,
    pub(crate) color: ColorId,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// From the centre to a corner.
    pub(crate) corner_radius: f64,
    /// Corners in plan, counter-clockwise from +x.
    corners: [(f64, f64); SIDES],
    /// Upright planes, outward; side `k` is between corners `k` and `k + 1`.
    pub(crate) sides: [Plane; SIDES],
}

impl Prism {
    pub(crate) fn new(shape: usize, x: f64, y: f64, radius: f64, band: &PostBand) -> Self {
        let corner_radius = CORNER_RADIUS * radius;
        let corners = std::array::from_fn(|k| {
            let (cos, sin) = direction(k);
            (x + corner_radius * cos, y + corner_radius * sin)
        });
        let sides = std::array::from_fn(|k| {
            let ((ax, ay), (bx, by)) = (corners[k], corners[(k + 1) % SIDES]);
            let normal = Vector3::new(by - ay, ax - bx, 0.0).normalize();
            Plane { normal, offset: normal.x * 0.5 * (ax + bx) + normal.y * 0.5 * (ay + by) }
        });
        Self { shape, color: band.color, x, y, from: band.from, to: band.to, corner_radius, corners, sides }
    }

    /// A corner at a height.
    pub(crate) fn corner(&self, k: usize, z: f64) -> Vector3<f64> {
        let (x, y) = self.corners[k % SIDES];
        Vector3::new(x, y, z)
    }

    /// Centre and radius of a ball around it.
    pub(crate) fn ball(&self) -> (Vector3<f64>, f64) {
        let half = 0.5 * (self.to - self.from);
        let radius = (self.corner_radius * self.corner_radius + half * half).sqrt();
        (Vector3::new(self.x, self.y, self.from + half), radius)
    }

    /// The upper end, outward.
    pub(crate) fn top(&self) -> Plane {
        Plane { normal: Vector3::z(), offset: self.to }
    }

    /// The lower end, outward.
    pub(crate) fn bottom(&self) -> Plane {
        Plane { normal: -Vector3::z(), offset: -self.from }
    }

    /// Where a ray from outside enters the solid, in multiples of `direction`.
    pub(crate) fn enter(&self, origin: &Vector3<f64>, direction: &Vector3<f64>) -> Option<f64> {
        let (mut enter, mut exit) = (0.0_f64, f64::INFINITY);
        for plane in self.sides.iter().chain(&[self.top(), self.bottom()]) {
            let (outside, speed) = (plane.distance(origin), plane.normal.dot(direction));
            let at = -outside / speed;
            if speed < 0.0 {
                enter = enter.max(at);
            } else if speed > 0.0 {
                exit = exit.min(at);
            } else if outside > 0.0 {
                return None;
            }
        }
        (enter > 0.0 && enter <= exit).then_some(enter)
    }
}

/// Cosine and sine of `k` sixteenths of a turn, without a call of the platform's library.
fn direction(k: usize) -> (f64, f64) {
    let cos = |k: usize| match k % SIDES {
        0 => 1.0,
        k @ 1..=3 => COSINES[k - 1],
        k @ 5..=7 => -COSINES[7 - k],
        8 => -1.0,
        k @ 9..=11 => -COSINES[k - 9],
        k @ 13..=15 => COSINES[15 - k],
        _ => 0.0,
    };
    (cos(k), cos(k + SIDES - SIDES / 4))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    #[test]
    fn directions_are_those_of_the_circle() {
        for k in 0..SIDES {
            let (sin, cos) = (k as f64 * std::f64::consts::TAU / SIDES as f64).sin_cos();
            let got = direction(k);
            assert!(
                abs_diff_eq!(got.0, cos, epsilon = 1e-15) && abs_diff_eq!(got.1, sin, epsilon = 1e-15),
                "{k}"
            );
        }
    }

    #[test]
    fn the_outline_is_as_long_as_the_circle() {
        let prism = Prism::new(0, 1.0, -2.0, 0.05, &PostBand { color: ColorId(0), from: 0.0, to: 0.2 });
        let length: f64 = (0..SIDES).map(|k| (prism.corner(k + 1, 0.0) - prism.corner(k, 0.0)).norm()).sum();
        assert_abs_diff_eq!(length / (std::f64::consts::TAU * 0.05), 1.0, epsilon = 1e-14);
    }
}
