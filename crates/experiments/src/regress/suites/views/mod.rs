//! Drives through scenes, composed or photographed, and along a corridor.

mod choices;
mod drive;
mod experiment;
mod scenes;
mod settings;
mod tables;

pub(super) use experiment::run;
