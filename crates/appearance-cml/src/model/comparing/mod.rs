//! Comparison of a view with the references of the map.

pub(super) mod place_match;
pub(super) mod scale_learner;
pub(super) mod similarity;
pub(super) mod view_scale;
