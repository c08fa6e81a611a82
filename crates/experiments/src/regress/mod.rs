//! `wayfix-experiments regress`: every system on stored logs, and on public recordings if available, against stated bounds.
//!
//! [`cells`] lists the work, run by run and seed by seed; [`run_shard`] does some or all of it; [`assemble`] makes the report. Shards on other
//! machines leave a [`ShardResults`] each, and [`join`] merges them.

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
pub mod suites;

pub use assemble::assemble;
pub use blessed::ReferenceFigures;
pub use campaign::{SeededRun, cells};
pub use costs::{EstimatedTime, RunCosts, calibration_seconds, thread_seconds};
pub use job::PlannedJob;
pub use part::{ShardResults, join};
pub use plan::{MetricBound, PlannedMean, PlannedRun, SuitePlan};
pub use runner::{CompletedRun, RegressOptions, run_shard};
pub use selection::RunSelection;
pub use shard::CampaignShard;
