//! The appearance map: reference views, the poses of each, and how both are learned and forgotten.

mod appearance_map;
mod comparing;
mod far;
mod grid;
mod interpolate;
mod learn;
mod merge;
mod params;
mod reference;
mod residual;
mod superpose;
mod weigh;

pub use appearance_map::AppearanceMap;
pub use comparing::place_match::PlaceMatch;
pub(crate) use comparing::scale_learner::ScaleLearner;
pub use comparing::similarity::similarity;
pub use comparing::view_scale::{ViewDifferenceModel, ViewDifferenceSample};
pub(crate) use far::{N_FAR, PlaceTest};
pub use interpolate::interpolate;
pub(crate) use interpolate::{GROUP_SIZE, HEADING_SIGMA};
pub use learn::MapUpdate;
pub use params::{AppearanceMapParams, ForgettingMode, ForgettingUncertainty, PlaceUpdateRule};
pub use reference::{PlaceComponent, ReferenceView};
pub use superpose::superpose;
