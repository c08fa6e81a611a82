//! A tracker that separates the shape and colours of a target from its surroundings.

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
