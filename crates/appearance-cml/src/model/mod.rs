//! What places look like: reference views, where each was seen, and how both are learned and forgotten.

mod appearance_map;
mod far;
mod grid;
mod heading_measurement;
mod interpolate;
mod known;
mod learn;
mod merge;
mod params;
mod place_match;
mod reference;
mod residual;
mod similarity;
mod superpose;
mod view_scale;
mod weigh;

pub use appearance_map::AppearanceMap;
pub(crate) use heading_measurement::HeadingMeasurement;
pub use interpolate::interpolate;
pub use learn::MapUpdate;
pub use params::{Forgetting, ForgettingParams, ForgettingUncertainty, MapParams, PlaceUpdate};
pub use place_match::PlaceMatch;
pub use reference::{PlaceComponent, Reference};
pub use similarity::similarity;
pub use superpose::superpose;
pub use view_scale::{LagSample, ViewScale};
