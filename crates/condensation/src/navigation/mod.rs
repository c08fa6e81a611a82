//! From anywhere to a goal, by looking around.

mod action;
mod localizer;
mod moment_transition;
mod navigator;
mod report;
mod routes;

pub use action::ActionChoice;
pub use localizer::{Localizer, LocalizerParams};
pub use navigator::{Navigator, NavigatorParams, World};
pub use report::{Arrival, RunReport};
pub use routes::Routes;
