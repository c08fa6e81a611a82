//! SLAM of Wayfix on logs: each front end takes the records of a log and yields a path, a map, events and figures.
//!
//! | module | system |
//! | --- | --- |
//! | [`slam`] | EKF-SLAM over any front end: saved maps, observability, anchors, external sensors |
//! | [`points`] | its front end for range-bearing detections |
//! | [`walls`] | its front end for laser scans |
//! | [`ranges`] | path and places of beacons from ranges, by a smoother |
//!
//! This crate writes no terminal output, and no files but saved maps.

pub mod points;
pub mod ranges;
pub mod slam;
pub mod walls;
