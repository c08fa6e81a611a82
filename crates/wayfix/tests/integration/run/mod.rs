//! `wayfix run` through the program, a file for each system.

mod cml;
mod cml_drive;
mod cml_lag;
mod lines;
mod optimize;
mod track;
mod views;
mod views_log;
mod walls;
