//! Points seen in range and bearing, in a window of time or in one batch.

mod export;
mod gaussian;
mod landmarks;
mod measurements;
mod pairing;
mod params;
mod residuals;
mod smoother;

pub use gaussian::PointMapGaussian;
pub use measurements::Detection;
pub use params::{PointSmootherParams, PoseObservation, SettledPose};
pub use residuals::{AntennaPosition, Heading, MountedRangeBearing};
pub use smoother::PointSmoother;
