//! The whole: predict with odometry, update with views, learn what was seen.

mod anywhere;
mod appearance_localizer;
mod belief;
mod breaks;
mod compass;
mod contest;
mod doubt;
mod fit;
mod journey;
mod learning;
mod observe;
mod outcome;
mod params;
mod relocation;
mod rival;
mod running_share;
mod scale_learner;
mod smooth;
mod start;
mod survey;
mod trail;

pub use appearance_localizer::AppearanceLocalizer;
pub use outcome::{Event, UpdateOutcome};
pub use params::{Learning, LocalizerParams, Observation};
pub use relocation::{Proof, RelocationParams};
pub use smooth::{Motion, smooth};
pub use start::Start;
