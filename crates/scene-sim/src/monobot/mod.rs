//! The one-dimensional robot of [Andrade-Cetto 2005, Sec. 2.2, Figs. 3–6]: a sinusoidal drive on a line, landmarks ahead, noise in
//! proportion to motion and distance.

mod records;
mod run;

pub use run::{MonobotParams, MonobotRun};
