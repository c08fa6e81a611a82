//! Probabilistic robot localization on logs: the application behind the command `wayfix`.
//!
//! Records of a log go through a [`system`] ([`slam`], [`color`], [`cml`], [`lines`]), pictures through [`views`] and [`track`]; [`evaluate`] compares its estimates with truth, [`plot`] draws them,
//! [`report`] writes figures and pictures; [`monobot`] are the experiments of a robot on a line and [`consistency`] those of one that drives laps; [`fixtures`] are the stored logs; [`cli`] is the command line.

pub mod cli;
pub mod cml;
pub mod color;
mod commented;
pub mod consistency;
pub mod evaluate;
pub mod fixtures;
pub mod lines;
#[cfg(feature = "live")]
pub mod live;
pub mod monobot;
pub mod plot;
pub mod regress;
pub mod report;
mod saved;
mod settings;
pub mod slam;
pub mod system;
pub mod track;
#[cfg(doctest)]
mod tutorials;
pub mod views;
pub mod walls;
