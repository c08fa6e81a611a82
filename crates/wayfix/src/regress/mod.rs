//! `wayfix regress`: every system on stored logs, and on public recordings where they are, against stated bounds.

mod blessed;
mod job;
mod plan;
mod runner;
pub mod suites;

pub use blessed::Blessed;
pub use job::Job;
pub use plan::{Bound, Plan, PlannedMean, PlannedRun};
pub use runner::{Options, n_runs, regress};
