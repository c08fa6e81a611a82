//! Trackers on simulated films, whose truth is a mask.

mod follow;
mod score;
mod table;

pub use follow::follow;
pub use score::FilmScore;
pub use table::table;
