//! The filter, one step of the algorithm per file.

mod expected_landmarks;
mod gates;
mod linearization;
mod map;
mod map_management;
mod params;
mod predict;
mod predicted_measurement;
mod resume;
mod search_region;
mod state;
mod step;
mod update;
mod update_robot;

pub use expected_landmarks::ExpectedLandmarks;
pub use linearization::LinearizationPoint;
pub use map_management::anchors::{AnchorError, AnchorParams};
pub use map_management::confirmation::LandmarkConfirmationParams;
pub use map_management::merge::LandmarkMergingParams;
pub use params::{CovarianceUpdate, OutlierRule, SlamParams, UpdateOrder};
pub use predicted_measurement::PredictedMeasurement;
pub use state::{EkfSlam, LandmarkEstimate};
