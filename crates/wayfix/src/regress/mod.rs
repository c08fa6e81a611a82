//! `wayfix regress`: every system on stored logs, and on public recordings where they are, against stated bounds.

mod blessed;
mod plan;
mod runner;

pub use blessed::Blessed;
pub use plan::{Bound, Plan, PlannedMean, PlannedRun};
pub use runner::{Options, n_runs, regress};
