//! `wayfix-experiments regress`: every system on stored logs, and on public recordings if available, against stated bounds.
//!
//! `cells` lists the work, run by run and seed by seed; `run_shard` does some or all of it; `assemble` makes the report. Shards on other
//! machines leave a `ShardResults` each, and `join` merges them.

mod assemble;
mod blessed;
mod campaign;
mod costs;
mod job;
mod over_seeds;
mod part;
mod plan;
mod runner;
mod selection;
mod shard;
pub(crate) mod suites;

pub(crate) use assemble::assemble;
pub(crate) use blessed::ReferenceFigures;
pub(crate) use campaign::{SeededRun, cells};
pub(crate) use costs::{RunCosts, calibration_seconds, thread_seconds};
pub(crate) use job::PlannedJob;
pub(crate) use part::{ShardResults, join};
pub(crate) use plan::{MetricBound, PlannedRun, SuitePlan};
pub(crate) use runner::{CompletedRun, RegressOptions, run_shard};
pub use selection::RunSelection;
pub use shard::CampaignShard;
