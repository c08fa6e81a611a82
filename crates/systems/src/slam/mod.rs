//! EKF-SLAM on a log: records → trajectory, map, figures, pictures, MCAP.

mod commands;
mod estimates;
mod event_name;
mod figures;
mod params;
mod pictures;
mod ranges;
mod run;
mod saved;
mod sequential_motion;
mod start;
mod system;
mod unknown_motion;

pub(crate) use estimates::draw_stamped_estimate;
pub use estimates::{SlamDrawing, SlamEstimateLog};
pub(crate) use event_name::event_name;
pub use figures::summarize;
pub(crate) use figures::{timings, unobservable_directions};
pub use params::{AssociationRule, MountingParams, Profile, RobotParams, SlamSystemParams};
pub use pictures::pictures;
pub use run::{SlamRun, run, run_on};
pub(crate) use saved::check_association;
pub use saved::{Odometry, Save, Saved, SavedMap, SavedMapError, SavedState, Saver, SystemState};
pub(crate) use start::{
    start_pose, warn_of_an_empty_map, warn_of_no_overlap, warn_of_reference, warn_of_start,
};
pub(crate) use system::seen_landmarks;
pub use system::{PointSensor, SlamSystem, StampedEstimate};
