//! A view compared with the references of the map: distance, place, heading.

pub(super) mod heading_measurement;
pub(super) mod place_match;
pub(super) mod similarity;
pub(super) mod view_scale;
