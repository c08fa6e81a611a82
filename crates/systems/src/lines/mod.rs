//! Walls in the scans of a log: line segments fitted to laser echoes.
//!
//! [`LineSystem`] takes the records, [`summarize`] gives the figures, [`plots`] the pictures, [`LineEstimateRecorder`] the scans and walls for viewers;
//! [`WallScore`] compares with true walls.

mod estimates;
mod figures;
mod plots;
mod system;
mod totals;
mod truth;

pub use estimates::{LineDrawing, LineEstimateRecorder};
pub use figures::summarize;
pub use plots::plots;
pub use system::{LineSystem, ScanWalls};
pub use truth::WallScore;
