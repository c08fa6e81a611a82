//! Walls in the scans of a log: line segments fitted to laser echoes.
//!
//! [`LineExtractionSystem`] takes the records, [`summarize`] gives the figures, [`plots`] the pictures, [`LineEstimateRecorder`] the scans and walls for viewers;
//! [`WallScore`] compares with true walls.

mod estimates;
mod figures;
mod plots;
mod system;
mod totals;
mod truth;

pub use estimates::{LineDrawingState, LineEstimateRecorder};
pub use figures::summarize;
pub use plots::plots;
pub use system::{LineExtractionSystem, ScanWalls};
pub use truth::WallScore;
