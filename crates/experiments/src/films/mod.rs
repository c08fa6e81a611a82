//! Trackers on simulated films, whose truth is a mask, and on a recording from other starts.

mod active;
mod follow;
mod learned;
mod score;
mod starts;
mod stereo;
mod table;

pub(crate) use active::active;
pub(crate) use follow::follow;
pub(crate) use learned::learned;
pub use score::FilmTrackingScore;
pub(crate) use starts::starts;
pub(crate) use stereo::stereo;
pub use table::table;
