//! A target followed from picture to picture while the light changes.

mod bounding_box;
mod distribution;
mod tracker;

pub use bounding_box::BoundingBox;
pub use distribution::{
    COLOR_DIM, ColorCloud, ColorDynamics, ColorState, ColorVector, ColorWarp, LearnedDynamics,
    PrincipalColors,
};
pub use tracker::{Target, TrackStatus, Tracker};
