//! CONDENSATION in colour space, validated by the contour.

mod agreement;
mod candidate;
mod color_similarity;
mod each;
mod follow;
mod history;
mod params;
mod recolor;
mod reference;
mod refine;
mod region;
mod regrow;
mod samples;
mod scene;
mod search;
mod start;
mod tracker;

pub use agreement::Agreement;
pub use params::{ContourTrackerParams, TrackingCues};
pub use tracker::ContourTracker;
