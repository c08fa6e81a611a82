use wayfix_estimation_traits::{LogWeight, Pose3};

use crate::ColorDensity;

/// The log-likelihood of camera poses given one image; the terms of the image alone are precomputed.
///
/// **Law**: the value is $`\ln p(z | x, \text{light})`$ in nats up to a constant that depends on neither pose nor light, so values of different
/// poses are comparable for any visible part of the map; never NaN for a finite pose and finite densities.
///
/// The reference is [`PixelLikelihood`](crate::PixelLikelihood), a faster equal one is [`PixelSpanLikelihood`](crate::PixelSpanLikelihood), and the fast
/// alternative is [`FeatureLikelihood`](crate::FeatureLikelihood).
pub trait CameraPoseLikelihood {
    /// The log-likelihood of the image from `camera_pose` (x forward along the optical axis, in the world), with `light[m]` the density of map
    /// colour `m`.
    fn log_likelihood(&mut self, camera_pose: &Pose3<f64>, light: &[ColorDensity]) -> LogWeight;
}
