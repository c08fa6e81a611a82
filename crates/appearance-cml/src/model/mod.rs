//! What places look like: reference views, where each was seen, and how both are learned and forgotten.

mod appearance_map;
mod comparing;
mod far;
mod grid;
mod interpolate;
mod known;
mod learn;
mod merge;
mod params;
mod reference;
mod residual;
mod superpose;
mod weigh;

pub use appearance_map::AppearanceMap;
pub(crate) use comparing::heading_measurement::HeadingMeasurement;
pub use comparing::place_match::PlaceMatch;
pub use comparing::similarity::similarity;
pub use comparing::view_scale::{ViewDifferenceSample, ViewDistanceScale};
pub use interpolate::interpolate;
pub use learn::MapUpdate;
pub use params::{
    AppearanceMapParams, ForgettingMode, ForgettingParams, ForgettingUncertainty, PlaceUpdateRule,
};
pub use reference::{PlaceComponent, ReferenceView};
pub use superpose::superpose;
