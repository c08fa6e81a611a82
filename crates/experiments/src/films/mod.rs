//! Trackers on simulated films, whose truth is a mask.

mod active;
mod follow;
mod learned;
mod score;
mod table;

pub use active::active;
pub use follow::follow;
pub use learned::learned;
pub use score::FilmTrackingScore;
pub use table::table;
