//! Localization and mapping at once, step by step: predict, match the view, fuse and simplify, test for a kidnapping, learn.
//! [Gross et al. 2005, Sec. 2]

mod appearance_localizer;
mod belief;
mod correct;
mod learn;
mod match_view;
mod measured_poses;
mod outcome;
mod params;
mod pose_history;
mod relocalize;
mod start;

pub use appearance_localizer::AppearanceLocalizer;
pub use outcome::{LocalizerEvent, ViewUpdateOutcome};
pub use params::{LocalizerParams, MapLearning, PoseHypothesisRule};
pub use start::StartPosePrior;
