//! CONDENSATION in colour space, validated by the contour.

mod follow;
mod history;
mod hypotheses;
mod params;
mod recolor;
mod reference;
mod refine;
mod region;
mod regrow;
mod scene;
mod search;
mod start;
mod tracker;

pub use hypotheses::agreement::ColorHypothesisAgreement;
pub use params::{ColorContourTrackerParams, TrackingCues};
pub use tracker::ColorContourTracker;
