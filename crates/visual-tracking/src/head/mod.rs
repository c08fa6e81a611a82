//! A head followed as an ellipse by the colours inside it and the edge around it. [Andrade-Cetto & Sanfeliu 2004, sec. 3.2; Birchfield 1998]

mod bimodal;
mod edge;
mod params;
mod scale_source;
mod search;
mod surroundings;
mod tracker;

pub use params::HeadTrackerParams;
pub use scale_source::{HeadSizeFromSearch, RelativeHeadSizeSource};
pub use tracker::HeadTracker;
