//! EKF-SLAM with points: the front end for range-bearing detections.

mod commands;
mod drawing;
mod figures;
mod follower;
mod front_end;
mod params;
mod plots;
mod ranges;
mod run;
mod state;

pub use figures::summarize;
pub use front_end::{PointSensor, PointSlamFrontEnd, PointSystem};
pub use params::{MountingParams, PointSlamParams, RobotProfile, RobotTimingParams};
pub use plots::plots;
pub use run::{PointRun, run, run_on, run_streamed};
pub use state::{PointFrontEndState, SavedPointMap};
