//! The whole: predict with odometry, update with views, learn what was seen.

mod appearance_localizer;
mod outcome;
mod params;
mod queue;
mod scale_learner;
mod smooth;
mod trail;

pub use appearance_localizer::{AppearanceLocalizer, Start};
pub use outcome::{Event, UpdateOutcome};
pub use params::{Learning, LocalizerParams, Observation};
pub use smooth::{Motion, smooth};
