//! What places look like: reference views, where each was seen, and how both are learned and forgotten.

mod appearance_map;
mod facing;
mod far;
mod grid;
mod interpolate;
mod known;
mod learn;
mod merge;
mod params;
mod reference;
mod residual;
mod sighting;
mod similarity;
mod superpose;
mod view_scale;
mod weigh;

pub use appearance_map::AppearanceMap;
pub(crate) use facing::Facing;
pub use interpolate::interpolate;
pub use learn::Learned;
pub use params::{Forgetting, ForgettingParams, ForgettingUncertainty, MapParams, PlaceUpdate};
pub use reference::{PlaceComponent, Reference};
pub use sighting::Sighting;
pub use similarity::similarity;
pub use superpose::superpose;
pub use view_scale::{LagSample, ViewScale};
