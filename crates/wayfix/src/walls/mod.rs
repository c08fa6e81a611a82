//! EKF-SLAM on laser scans: walls in every scan → map of walls, path, figures, pictures.

mod estimates;
mod figures;
mod params;
mod pictures;
mod run;
mod system;
mod travel;
mod truth;

pub use estimates::{WallDrawing, WallEstimateLog};
pub use figures::{relation_metrics, summarize};
pub use params::{Gait, WallSlamParams};
pub use pictures::pictures;
pub use run::{WallRun, run};
pub use system::{WallModel, WallSystem};
