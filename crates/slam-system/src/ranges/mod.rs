//! Ranges to beacons of unknown place: path, beacons, calibration and noise by one batch.

mod figures;
mod input;
mod run;

pub use figures::{plots, summarize};
pub use run::{RangeRun, run};
