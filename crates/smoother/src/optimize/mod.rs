//! Linearize, solve, retract, judge.

mod damping;
mod graduated;
mod minimize;
mod params;

pub(crate) use graduated::run;
pub use params::{Method, Params, Stop, Summary};
