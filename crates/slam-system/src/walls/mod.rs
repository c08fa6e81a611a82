//! EKF-SLAM on laser scans: walls in every scan → map of walls, path, figures, pictures.

mod batch;
mod drawing;
mod figures;
mod front_end;
mod match_to_keyframe;
mod odometry;
mod odometry_scale;
mod params;
mod plots;
mod relative_motion;
mod repeated_scan;
mod run;
mod scan;
mod state;
mod truth;

pub use figures::{relation_metrics, summarize};
pub use front_end::{WallModel, WallSlamFrontEnd, WallSystem};
pub use odometry::OdometryBetweenScans;
pub use params::{KeyframeThreshold, OdometryNoisePerScan, WallSlamParams};
pub use plots::plots;
pub use relative_motion::RelativeMotion;
pub use run::{WallRun, run, run_on, run_streamed};
pub use state::{SavedScan, SavedWallMap, WallFrontEndState};
