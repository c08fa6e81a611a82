//! A target followed by how its shape and its colours stand out from what is around it.

mod channels;
mod filter;
mod lost;
mod params;
mod recenter;
mod recognizer;
mod response;
mod scale_filter;
mod tracker;
mod turned;
mod window;

pub use params::CorrelationTrackerParams;
pub use tracker::CorrelationTracker;
