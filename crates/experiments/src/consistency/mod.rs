//! Consistency of SLAM filters: many laps of a loop with the standard filter, and with filters that preserve the unobservable directions.
//!
//! The filter has the true noise of the simulation, so inconsistency comes from the filter and not from its calibration.

mod drive;
mod figures;
mod filter_kind;
mod laps;
mod plots;

pub use drive::{ConsistencySample, drive};
pub use figures::{ConsistencyMonteCarlo, FilterMonteCarloResults, monte_carlo, over_logs};
pub use filter_kind::ComparedFilter;
pub use laps::CorridorLaps;
pub use plots::picture;
