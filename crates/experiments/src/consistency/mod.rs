//! Does a SLAM filter know how wrong it is? Laps of a loop, many times over, through the standard filter and through those that keep the
//! freedom of the whole world open.
//!
//! The filter is given the noise that the simulation really used: what leaves the band then is the filter, not its calibration.

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
