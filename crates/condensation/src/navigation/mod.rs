//! From anywhere to a goal, by looking around.

mod action;
mod localizer;
mod moment_transition;
mod navigator;
mod report;
mod routes;

pub use action::ActionSelection;
pub use localizer::{ViewLocalizer, ViewLocalizerParams};
pub use navigator::{NavigationEnvironment, Navigator, NavigatorParams};
pub use report::{NavigationOutcome, NavigationReport};
pub use routes::ShortestPathLengths;
