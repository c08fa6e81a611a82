//! Estimates against truth: [`errors`] compares them, [`plot`] draws them, [`report`] writes figures and pictures as JSON and HTML.
//!
//! [`terminal`] prints them.
//!
//! Nothing here knows an estimator: numbers, poses and covariances come in.

pub mod errors;
pub mod plot;
pub mod report;
pub mod terminal;
