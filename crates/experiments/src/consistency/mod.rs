//! Consistency of SLAM filters: many laps of a loop with the standard filter, and with filters that preserve the unobservable directions.
//!
//! The filter has the true noise of the simulation, so inconsistency comes from the filter and not from its calibration.

mod drive;
mod figures;
mod filter_kind;
mod laps;
mod plots;

pub use drive::ConsistencySample;
pub(crate) use drive::drive;
pub(crate) use figures::over_logs;
pub use figures::{ConsistencyMonteCarlo, FilterMonteCarloResults, monte_carlo};
pub use filter_kind::ComparedFilter;
pub use laps::CorridorLaps;
pub(crate) use plots::picture;
