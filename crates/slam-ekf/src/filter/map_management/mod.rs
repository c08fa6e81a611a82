//! Which landmarks are in the map: anchors, confirmation, merging, retirement.

pub(super) mod anchors;
pub(super) mod confirmation;
pub(super) mod merge;
pub(super) mod retire;
