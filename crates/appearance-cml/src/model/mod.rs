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
pub use comparing::view_scale::{LagSample, ViewScale};
pub use interpolate::interpolate;
pub use learn::MapUpdate;
pub use params::{Forgetting, ForgettingParams, ForgettingUncertainty, MapParams, PlaceUpdate};
pub use reference::{PlaceComponent, Reference};
pub use superpose::superpose;
