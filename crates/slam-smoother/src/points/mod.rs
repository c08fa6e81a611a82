//! Points seen in range and bearing, with given pairings, in a window of time or in one batch.

mod export;
mod params;
mod residuals;
mod smoother;

pub use params::{PointSmootherParams, PoseObservation, SettledPose, StartPose};
pub use residuals::{AntennaPosition, Heading, MountedRangeBearing};
pub use smoother::{Detection, PointSmoother};
