//! Rotations and poses in space on `libm`, so that a picture has equal bits on every machine.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use wayfix_estimation_traits::{Pose2, Pose3};

/// A turn about the z axis, counter-clockwise seen from above, radians.
///
/// ```
/// use wayfix_estimation_traits::nalgebra::Vector3;
/// use wayfix_scene_sim::space;
/// let left = space::yaw(std::f64::consts::FRAC_PI_2) * Vector3::x();
/// assert!((left - Vector3::y()).norm() < 1e-15);
/// let down = space::pitch(std::f64::consts::FRAC_PI_2) * Vector3::x();
/// assert!((down + Vector3::z()).norm() < 1e-15, "positive pitch points down");
/// ```
pub fn yaw(angle: f64) -> UnitQuaternion<f64> {
    about(Vector3::z(), angle)
}

/// A turn about the y axis, positive with the nose down, radians.
pub fn pitch(angle: f64) -> UnitQuaternion<f64> {
    about(Vector3::y(), angle)
}

/// A turn about the x axis, positive with the right side down, radians.
pub fn roll(angle: f64) -> UnitQuaternion<f64> {
    about(Vector3::x(), angle)
}

/// A pose on the ground as one in space.
pub fn on_ground(pose: &Pose2<f64>) -> Pose3<f64> {
    Pose3 { translation: Vector3::new(pose.x(), pose.y(), 0.0), rotation: yaw(pose.heading()) }
}

/// The pose at `share` between two poses; for small differences only, where the chord approximates the arc.
pub fn between(from: &Pose3<f64>, to: &Pose3<f64>, share: f64) -> Pose3<f64> {
    let (a, b) = (from.rotation.into_inner(), to.rotation.into_inner());
    let b = if a.coords.dot(&b.coords) < 0.0 { -b } else { b };
    Pose3 {
        translation: from.translation + (to.translation - from.translation) * share,
        rotation: UnitQuaternion::new_normalize(a + (b - a) * share),
    }
}

fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = libm::sincos(0.5 * angle);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis * sin))
}
