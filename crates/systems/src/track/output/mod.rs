//! What a run of a tracker draws and writes.

pub(super) mod decimated;
pub(super) mod estimates;
pub(super) mod overlay;
pub(super) mod pictures;
pub(super) mod run_history;
