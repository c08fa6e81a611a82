use wayfix_estimation_traits::{LogWeight, Pose3};

use crate::ColorDensity;

/// One image as a log-likelihood of camera poses: everything that depends only on the image is done before.
///
/// **Law**: the value is $`\ln p(z | x, \text{light})`$ in nats up to a constant that depends on neither pose nor light, so that values of different
/// poses compare however much of the map they see; never NaN for a finite pose and finite densities.
///
/// The reference is [`PixelLikelihood`](crate::PixelLikelihood), the same numbers at a fraction of the cost [`SpanLikelihood`](crate::SpanLikelihood), the fast
/// alternative [`FeatureLikelihood`](crate::FeatureLikelihood).
pub trait ViewLikelihood {
    /// The log-likelihood of the image from `camera_pose` (x forward along the optical axis, in the world), with `light[m]` the density of map
    /// colour `m`.
    fn log_likelihood(&mut self, camera_pose: &Pose3<f64>, light: &[ColorDensity]) -> LogWeight;
}
