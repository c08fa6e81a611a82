//! A head followed as an ellipse by the colours inside it and the edge around it. [Andrade-Cetto & Sanfeliu 2004, sec. 3.2; Birchfield 1998]

mod bimodal;
mod detector;
mod edge;
mod likelihood;
mod params;
mod scale_source;
mod search;
mod surroundings;
mod tracker;

pub use detector::HeadDetector;
pub use params::HeadTrackerParams;
pub use scale_source::{DistanceScale, ScaleSource, SearchedScale};
pub use tracker::HeadTracker;
