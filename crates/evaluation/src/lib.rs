//! Comparison of estimates with truth: [`errors`] compares them, [`plot`] draws them, [`report`] writes figures and pictures as JSON and HTML.
//! [`terminal`] prints them.
//!
//! This crate does not depend on an estimator: its inputs are numbers, poses and covariances.

pub mod errors;
pub mod plot;
pub mod report;
pub mod terminal;
