//! The estimators of Wayfix behind one trait: a [`system::System`] takes the records of a log and yields estimates, events and figures.
//!
//! | module | system |
//! | --- | --- |
//! | [`slam`] | EKF-SLAM; [`points`] from range-bearing detections, [`walls`] from laser scans |
//! | [`ranges`] | path and places of beacons from ranges, by a smoother |
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
pub mod points;
pub mod ranges;
pub mod saved;
pub mod settings;
pub mod slam;
pub mod system;
pub mod track;
pub mod views;
pub mod walls;
