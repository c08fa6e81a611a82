//! A target followed by how its shape and its colours stand out from what is around it.

mod color_channels;
mod color_ratio;
mod features;
mod filter;
mod fourier;
mod gradient_channels;
mod lane;
mod lost;
mod params;
mod patch;
mod planes;
mod recenter;
mod recognizer;
mod response;
mod scale_filter;
mod tracker;
mod turned;
mod window;

pub use params::CorrelationTrackerParams;
pub use tracker::CorrelationTracker;
