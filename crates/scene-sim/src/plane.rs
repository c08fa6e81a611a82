//! Planar geometry on `libm`, so that a scene has equal bits on every machine.
//!
//! [`Pose2`]'s own operations call the platform's sine and cosine, whose last digit differs between machines.

use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

/// The unit vector at `angle` radians from the x axis.
///
/// ```
/// let up = wayfix_scene_sim::plane::direction(std::f64::consts::FRAC_PI_2);
/// assert!((up.y - 1.0).abs() < 1e-15 && up.x.abs() < 1e-15);
/// ```
pub fn direction(angle: f64) -> Vector2<f64> {
    let (sin, cos) = libm::sincos(angle);
    Vector2::new(cos, sin)
}

/// A world point in the frame of `pose`: x ahead, y to the left.
pub fn to_body(pose: &Pose2<f64>, point: &Vector2<f64>) -> Vector2<f64> {
    let (ahead, offset) = (direction(pose.heading()), point - pose.translation);
    Vector2::new(ahead.dot(&offset), ahead.perp(&offset))
}

/// Range in metres and bearing in (−π, π] of a world point seen from `pose`.
///
/// ```
/// use wayfix_estimation_traits::{Pose2, nalgebra::Vector2};
/// use wayfix_scene_sim::plane::range_and_bearing;
/// let (range, bearing) = range_and_bearing(&Pose2::new(1.0, 0.0, 0.0), &Vector2::new(1.0, 2.0));
/// assert!((range - 2.0).abs() < 1e-15 && (bearing - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// ```
pub fn range_and_bearing(pose: &Pose2<f64>, point: &Vector2<f64>) -> (f64, f64) {
    let seen = to_body(pose, point);
    (libm::hypot(seen.x, seen.y), libm::atan2(seen.y, seen.x))
}

/// `to` in the frame of `from`.
pub fn relative(from: &Pose2<f64>, to: &Pose2<f64>) -> Pose2<f64> {
    let offset = to_body(from, &to.translation);
    Pose2::new(offset.x, offset.y, to.heading() - from.heading())
}

/// End pose of a drive of `distance` metres along an arc that turns by `turn` radians.
///
/// The chord has length $`d \, \frac{\sin(φ/2)}{φ/2}`$ and points half the turn to the left of the start.
pub fn advance(pose: &Pose2<f64>, distance: f64, turn: f64) -> Pose2<f64> {
    let half = 0.5 * turn;
    let chord = if half.abs() < 1e-4 { 1.0 - half * half / 6.0 } else { libm::sin(half) / half };
    let end = pose.translation + direction(pose.heading() + half) * (distance * chord);
    Pose2::new(end.x, end.y, pose.heading() + turn)
}
