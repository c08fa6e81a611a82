//! Reproduction of the papers: plans of runs on stored logs and on public recordings, their bounds, and a report of all.
//!
//! [`regress`] runs the suites; [`fixtures`] are the stored logs. [`monobot`] and [`consistency`] are experiments with simulated robots; `color`,
//! `cml`, [`films`], [`corridor`], [`labelled`], `simplification` and [`venues`] are those of one system each.

pub mod cli;
mod cml;
mod color;
pub mod consistency;
pub mod corridor;
mod error_quantiles;
pub mod films;
pub mod fixtures;
pub mod labelled;
pub mod monobot;
pub mod regress;
mod simplification;
mod thinned_measurements;
pub mod venues;
mod views_paper;

pub use views_paper::PaperSceneRows;
