//! `wayfix run`: a file for each system.

pub(super) mod interrupt;
pub(super) mod run_cml;
pub(super) mod run_color;
pub(super) mod run_lines;
pub(super) mod run_ranges;
pub(super) mod run_slam;
pub(super) mod run_track;
pub(super) mod run_views;
pub(super) mod run_walls;
