//! Appearance maps with [`AppearanceLocalizer`](wayfix_appearance_cml::AppearanceLocalizer): learn places, recognize them and forget them.
//!
//! A [`CmlRunPlan`] of a log or of a [`PosedFrameFolder`](wayfix_table_log::PosedFrameFolder) selects the views to learn and to localize, [`run`] executes it with a
//! [`CmlSystem`], [`summarize`] gives the figures and [`plots`] the pictures.

mod estimates;
mod external;
mod figures;
mod odometry;
mod params;
mod plan;
mod plots;
mod reader;
mod run;
mod saved;
mod system;
mod turn_evidence;

pub use wayfix_evaluation::plot::histogram;

pub use estimates::{CmlDrawingState, CmlEstimateRecorder};
pub use figures::{summarize, task};
pub use odometry::synthetic_odometry;
pub use params::{CmlParams, PoseSigmas, SyntheticOdometry};
pub use plan::{CameraViewGeometry, CmlRunPlan, N_EVIDENCE};
pub use plots::plots;
pub use reader::ViewDescriptorReader;
pub use run::{CmlRun, CmlRunSetup, CmlStartPose, CmlTask, first_true_pose, run, run_streamed};
pub use saved::{PeriodicMapSaver, SavedViewMapError, end_note, read_map};
pub use system::{CmlSystem, CmlViewResult, PanoramaLocalizer, PanoramaMap};
