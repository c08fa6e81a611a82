//! Walls in the scans of a log: what a laser sees, as lines with their ends.
//!
//! [`LineSystem`] takes the records, [`summarize`] gives the figures, [`pictures`] the pictures, [`LineLog`] the scans and walls for viewers.

mod estimates;
mod figures;
mod pictures;
mod system;

pub use estimates::LineLog;
pub use figures::summarize;
pub use pictures::pictures;
pub use system::{LineSystem, ScanWalls};
