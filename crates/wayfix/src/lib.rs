//! The command `wayfix`: probabilistic robot localization on logs.
//!
//! Records of a log go through one of the [systems](wayfix_systems); [`wayfix_evaluation`] compares the estimates with truth and writes the report; [`cli`] is the command line.

pub mod cli;
mod commented;
#[cfg(feature = "live")]
pub mod live;
#[cfg(doctest)]
mod tutorials;
