//! Consistency of SLAM filters: many laps of a loop with the standard filter, and with filters that preserve the unobservable directions.
//!
//! The filter has the true noise of the simulation, so inconsistency comes from the filter and not from its calibration.

mod drive;
mod figures;
mod filter_kind;
mod laps;
mod pictures;

pub use drive::{ConsistencySample, drive};
pub use figures::{FilterHistory, MonteCarlo, monte_carlo};
pub use filter_kind::FilterKind;
pub use laps::Laps;
pub use pictures::picture;
