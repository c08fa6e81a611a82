//! The filter, one step of the algorithm a file.

mod gates;
mod map;
mod params;
mod predict;
mod sight;
mod state;
mod update;

pub use params::SlamParams;
pub use sight::PredictedSighting;
pub use state::{EkfSlam, LandmarkEstimate};
