//! Global search: the places that explain the last frames.

mod axes;
mod candidate;
mod detections;
mod evidence;
mod global_search;
mod place_evidence;
mod pyramid;
mod start;
mod trajectory;

pub(crate) use global_search::{Found, Search, check_area};
pub(crate) use start::Area;
pub use start::StartPosePrior;
