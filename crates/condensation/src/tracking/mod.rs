//! A target followed from picture to picture while the light changes.

mod bounding_box;
mod tracker;

pub use bounding_box::BoundingBox;
pub use tracker::{Target, TrackStatus, Tracker};
