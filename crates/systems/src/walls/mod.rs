//! EKF-SLAM on laser scans: walls in every scan → map of walls, path, figures, pictures.

mod estimates;
mod figures;
mod match_to_keyframe;
mod odometry;
mod params;
mod pictures;
mod relative_motion;
mod run;
mod saved;
mod scan;
mod system;
mod truth;

pub use estimates::{WallDrawing, WallEstimateLog};
pub use figures::{relation_metrics, summarize};
pub use odometry::Odometry;
pub use params::{KeyframeThreshold, OdometryNoisePerScan, WallSlamParams};
pub use pictures::pictures;
pub use relative_motion::RelativeMotion;
pub use run::{WallRun, run, run_on};
pub use saved::WallState;
pub use system::{WallModel, WallSystem};
