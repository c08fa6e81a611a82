//! The unscented transform: sigma points, their images, the weighted mean on a manifold.

pub(crate) mod sigma_points;
pub(crate) mod transform;
pub(crate) mod unscented;
pub(crate) mod weighted_mean;
