//! A target followed from picture to picture while the light changes.

mod bounding_box;
mod correlation;
mod tracker;

pub use bounding_box::BoundingBox;
pub use correlation::{CorrelationTracker, CorrelationTrackerParams};
pub use tracker::{Target, TrackStatus, Tracker};
