//! The filter, one step of the algorithm a file.

mod confirmation;
mod gates;
mod map;
mod params;
mod predict;
mod sight;
mod state;
mod update;

pub use confirmation::Confirmation;
pub use params::{MapForm, OutlierRule, SlamParams, UpdateOrder};
pub use sight::PredictedSighting;
pub use state::{EkfSlam, LandmarkEstimate};
