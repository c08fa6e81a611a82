//! Localization and vision of Wayfix on logs: each module is a [`System`](wayfix_system_core::System) that takes the records of a log and yields estimates,
//! events and figures. SLAM is in `wayfix-slam-system`.
//!
//! | module | system |
//! | --- | --- |
//! | [`lines`] | walls of single scans |
//! | [`color`] | localization in a coloured map |
//! | [`cml`] | localization and mapping by appearance |
//! | [`views`] | which view of a scene a camera shows |
//! | [`track`] | a target in images |
//!
//! This crate writes no terminal output, and no files but saved maps.

pub mod cml;
pub mod color;
pub mod lines;
pub mod track;
pub mod views;
