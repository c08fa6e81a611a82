//! What several tests need.

use rand::{Rng, RngExt};
use wayfix_color_map::{
    ColorId, ColorMap, LabelImage, PinholeCamera,
    nalgebra::{Quaternion, UnitQuaternion, Vector3},
};
use wayfix_estimation_traits::Pose3;

/// A field of the four-legged league of 2003: 4.2 m × 2.7 m, two goals, six beacons.
#[cfg(feature = "serde")]
pub(crate) fn field() -> ColorMap {
    toml::from_str(include_str!("../../field.toml")).expect("the field is a map")
}

/// Anywhere within `reach` of the origin, to either side and above and below, looking anywhere.
pub(crate) fn random_pose<R: Rng + ?Sized>(rng: &mut R, reach: f64) -> Pose3<f64> {
    let mut within = |reach: f64| rng.random_range(-reach..reach);
    let translation = Vector3::new(within(reach), within(reach), within(0.5));
    let quaternion = Quaternion::new(within(1.0), within(1.0), within(1.0), within(1.0));
    Pose3 { translation, rotation: UnitQuaternion::from_quaternion(quaternion) }
}

/// The colour that every pixel's centre ray meets.
pub(crate) fn cast_labels(map: &ColorMap, camera: &PinholeCamera, pose: &Pose3<f64>) -> LabelImage {
    let mut codes = Vec::new();
    for row in 0..camera.height() {
        for column in 0..camera.width() {
            let ray = pose.rotation * camera.ray(f64::from(column) + 0.5, f64::from(row) + 0.5);
            codes.push(map.cast(&pose.translation, &ray).map_or(0, |hit| hit.color.0 + 1));
        }
    }
    LabelImage::from_codes(camera.width(), camera.height(), &codes).expect("a code for every pixel")
}

/// Column, row and the two labels where two images first differ.
pub(crate) fn first_difference(
    a: &LabelImage,
    b: &LabelImage,
) -> Option<(usize, usize, Option<ColorId>, Option<ColorId>)> {
    let i = a.pixels().iter().zip(b.pixels()).position(|(a, b)| a != b)?;
    Some((i % a.width() as usize, i / a.width() as usize, a.pixels()[i], b.pixels()[i]))
}

/// Any size, also a single pixel, and an axis anywhere, also beside the image.
pub(crate) fn random_camera<R: Rng + ?Sized>(rng: &mut R) -> PinholeCamera {
    let (width, height) = (rng.random_range(1..140), rng.random_range(1..80));
    let (fx, fy) = (rng.random_range(20.0..200.0), rng.random_range(20.0..200.0));
    let mut axis = |side: u32| f64::from(side) * rng.random_range(-0.2..1.2);
    PinholeCamera::new(width, height, fx, fy, axis(width), axis(height)).expect("a valid camera")
}
