//! Trackers on simulated films, whose truth is a mask.

mod active;
mod follow;
mod learned;
mod score;
mod table;

pub(crate) use active::active;
pub(crate) use follow::follow;
pub(crate) use learned::learned;
pub use score::FilmTrackingScore;
pub use table::table;
