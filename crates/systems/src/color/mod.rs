//! Adaptive colour localization on logs: the robot's pose on a coloured field, and the effect of the light on the colours.
//!
//! [`run`] passes the records of a log through a [`ColorSystem`] with a map and priors; [`summarize`] gives the figures, [`plots`] the pictures.

mod camera;
mod estimates;
mod figures;
mod frame_result;
mod labels;
mod map;
mod params;
mod particle_film;
mod plots;
pub mod priors;
mod run;
mod system;
mod totals;

pub use camera::RecordIterator;
pub use estimates::{ColorDrawingState, ColorEstimateRecorder};
pub use figures::summarize;
pub use frame_result::ColorFrameResult;
pub use labels::{ClassificationCounts, rate_of, tally};
pub use map::{field_lines, read_map};
pub use params::{ColorSystemParams, StartPoseUncertainty};
pub use particle_film::ParticleSnapshots;
pub use plots::{film, plots, uv_ellipses};
pub use run::{ColorRun, ColorRunSetup, n_images, run, run_streamed};
pub use system::{ColorSystem, StartPose};
