//! Trackers on simulated films, whose truth is a mask.

mod follow;
mod score;
mod table;

pub use follow::follow;
pub use score::FilmTrackingScore;
pub use table::table;
