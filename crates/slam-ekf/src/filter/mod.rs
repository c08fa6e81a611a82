//! The filter, one step of the algorithm a file.

mod confirmation;
mod gates;
mod linearization;
mod map;
mod merge;
mod params;
mod predict;
mod reach;
mod resume;
mod retire;
mod sight;
mod state;
mod step;
mod update;
mod update_robot;

pub use confirmation::Confirmation;
pub use linearization::Linearization;
pub use merge::Merging;
pub use params::{MapForm, OutlierRule, SlamParams, UpdateOrder};
pub use sight::PredictedSighting;
pub use state::{EkfSlam, LandmarkEstimate};
