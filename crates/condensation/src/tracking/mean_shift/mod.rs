//! One hypothesis that climbs to where the target's colours are densest.

mod back_projection;
mod params;
mod tracker;

pub use back_projection::{BackProjection, Moments};
pub use params::MeanShiftParams;
pub use tracker::MeanShift;
