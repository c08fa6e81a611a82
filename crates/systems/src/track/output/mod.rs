//! Pictures and files of a tracker run.

pub(super) mod estimates;
pub(super) mod overlay;
pub(super) mod plots;
pub(super) mod run_history;
