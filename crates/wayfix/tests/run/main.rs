//! `wayfix run` through the program, a file for each system.

#[path = "../common/mod.rs"]
mod common;

mod cml;
mod lines;
mod track;
mod views;
mod walls;
