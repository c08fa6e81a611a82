//! A head followed as an ellipse by the colours inside it and the edge around it. [Andrade-Cetto 2005, Sec. 3.2, Fig. 9; Birchfield 1998]

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
pub use scale_source::{DistanceScale, HeadSizeFromSearch, RelativeHeadSizeSource};
pub use tracker::HeadTracker;
