use wayfix_estimation_traits::{LogWeight, Pose3};

use crate::ColorDensity;

/// The log-likelihood of camera poses given one image; the terms of the image alone are precomputed.
///
/// **Law**: the value is $`\ln p(z | x, \text{light})`$ in nats up to a constant that depends on neither pose nor light, so values of different
/// poses are comparable for any visible part of the map; never NaN for a finite pose and finite densities.
///
/// The reference is [`PixelLikelihood`](crate::PixelLikelihood), a faster equal one is [`PixelSpanLikelihood`](crate::PixelSpanLikelihood), and the fast
/// alternative is [`FeatureLikelihood`](crate::FeatureLikelihood).
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{Matrix3, Vector3};
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera};
/// # use wayfix_color_model::{CameraPoseLikelihood, ColorDensity, PixelLikelihood, PixelLikelihoodParams, YuvImage};
/// # use wayfix_estimation_traits::{LieGroup, Pose3};
/// # let vertices = [[-9.0, -9.0], [0.0, -9.0], [0.0, 9.0], [-9.0, 9.0]].map(|[y, z]| Vector3::new(2.0, y, z)).to_vec();
/// # let wall = ColoredShape::Polygon { color: ColorId(0), vertices };
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![wall])?);
/// # let renderer = MapRenderer::new(map, PinholeCamera::from_field_of_view(4, 2, 1.0, 0.5)?);
/// # let light = [ColorDensity { mean: Vector3::new(90.0, 110.0, 100.0), covariance: Matrix3::identity() * 25.0 }];
/// // From the origin, a green wall is in the right half of the view; from the left it is out of sight, from the right it is everywhere.
/// let image = YuvImage::new(4, 2, [[20, 128, 128], [20, 128, 128], [90, 110, 100], [90, 110, 100]].repeat(2))?;
/// let mut likelihood = PixelLikelihood::new(&image, |_| Some(10.0), renderer, PixelLikelihoodParams::as_published())?;
/// let [origin, left, right] = [0.0, 5.0, -5.0].map(|y| {
///     likelihood.log_likelihood(&Pose3 { translation: Vector3::new(0.0, y, 0.0), ..Pose3::identity() }, &light)
/// });
/// assert!(origin > left && left > right);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait CameraPoseLikelihood {
    /// The log-likelihood of the image from `camera_pose` (x forward along the optical axis, in the world), with `light[m]` the density of map
    /// colour `m`.
    fn log_likelihood(&mut self, camera_pose: &Pose3<f64>, light: &[ColorDensity]) -> LogWeight;
}
