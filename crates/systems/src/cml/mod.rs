//! Appearance maps with [`AppearanceLocalizer`](wayfix_appearance_cml::AppearanceLocalizer): learn places, recognize them and forget them.
//!
//! A [`Plan`] of a log or of a [`Recording`](recording::Recording) selects the views to learn and to localize, [`run`] executes it with a
//! [`CmlSystem`], [`summarize`] gives the figures and [`pictures`] the pictures.

mod estimates;
mod figures;
mod histogram;
pub use histogram::histogram;
mod odometry;
mod params;
mod pictures;
mod plan;
mod reader;
pub mod recording;
mod run;
mod saved;
mod system;

pub use estimates::{CmlDrawing, CmlEstimateLog};
pub use figures::{summarize, task};
pub use odometry::synthetic_odometry;
pub use params::{CmlParams, PoseSigmas, SyntheticOdometry};
pub use pictures::pictures;
pub use plan::{CameraChoice, Plan};
pub use reader::ViewReader;
pub use run::{CmlRun, StartPlace, Task, first_true_pose, run};
pub use saved::{MapSaver, SavedViewsError, end_note, read_map};
pub use system::{CmlSystem, FrameResult, PanoramaLocalizer, PanoramaMap};
