//! Walls in the scans of a log: what a laser sees, as lines with their ends.
//!
//! [`LineSystem`] takes the records, [`summarize`] gives the figures, [`pictures`] the pictures, [`LineLog`] the scans and walls for viewers;
//! [`WallScore`] compares with true walls, [`simplification`] makes chains short.

mod estimates;
mod figures;
mod pictures;
mod simplification;
mod system;
mod truth;

pub use estimates::{LineDrawing, LineLog};
pub use figures::summarize;
pub use pictures::pictures;
pub use simplification::simplification;
pub use system::{LineSystem, ScanWalls};
pub use truth::WallScore;
