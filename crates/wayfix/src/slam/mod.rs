//! EKF-SLAM on a log: records → trajectory, map, figures, pictures, MCAP.

mod commands;
mod figures;
mod params;
mod run;
mod system;

pub use figures::metrics;
pub use params::{AssociationRule, Profile, RobotParams, SlamSystemParams};
pub use run::{SlamRun, run};
pub use system::{Keyframe, SlamSystem};
