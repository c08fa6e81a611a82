//! Linearize, solve, retract, judge.

mod damping;
mod graduated;
mod minimize;
mod params;

pub(crate) use graduated::run;
pub(crate) use minimize::NOTHING_TO_GAIN;
pub use params::{Method, Params, Stop, Summary};
