//! Which landmarks are in the map: confirmation, merging, retirement.

pub(super) mod confirmation;
pub(super) mod merge;
pub(super) mod retire;
