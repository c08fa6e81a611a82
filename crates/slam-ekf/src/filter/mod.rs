//! The filter, one step of the algorithm per file.

mod confirmation;
mod gates;
mod linearization;
mod map;
mod merge;
mod params;
mod predict;
mod predicted_measurement;
mod resume;
mod retire;
mod search_region;
mod state;
mod step;
mod update;
mod update_robot;

pub use confirmation::ConfirmationParams;
pub use linearization::Linearization;
pub use merge::MergingParams;
pub use params::{MapForm, OutlierRule, SlamParams, UpdateOrder};
pub use predicted_measurement::PredictedMeasurement;
pub use state::{EkfSlam, LandmarkEstimate};
