//! What every system on logs shares: the trait [`System`], the way of records through it, checks of records, and the events that count what is refused.
//!
//! | question | item |
//! | --- | --- |
//! | How do records pass through a system? | [`drive`] |
//! | What writes the estimates for viewers? | [`EstimateRecorder`], [`EstimateDrawer`] |
//! | Where does a run start, and what does the truth cover? | [`TrueStartPose`], [`warn_of_start`], [`warn_of_no_overlap`] |
//! | Which parameters are overridden? | [`settings`] |
//! | Do odometry and measurements overlap in time? | [`check_overlap`] |
//! | Can a robot move like that? | [`IncrementPlausibilityCheck`], [`check_velocity`] |
//! | How does the odometry of a log move the robot? | [`LoggedOdometry`] |
//! | What moved a robot with a held velocity command? | [`HeldVelocity`] |
//! | How did a robot move between two times? | [`motion_between`] |
//! | Is the odometry late? | [`TurnHistory`], [`without_odometry_delay`] |
//! | Does a camera hang? | [`RepeatedImageCheck`] |
//! | Is the compass mirrored? | [`HeadingSignTest`] |

mod atomic;
mod drive;
mod estimate_recorder;
mod known_start;
mod laser;
mod measurement;
mod records;
mod robot_drawing;
pub mod settings;
mod system;
mod truth_warnings;

pub use atomic::write_atomically;
pub use drive::{RunStep, drive};
pub use estimate_recorder::{EstimateDrawer, EstimateRecorder, EstimateWriter, OTHER_POSES};
pub use known_start::TrueStartPose;
pub use laser::max_echo_range;
pub use measurement::map_measurement;
pub use records::{
    DETECTIONS, EventCounts, HeadingSignTest, HeldVelocity, HeldVelocityMotion, IMAGES,
    IncrementPlausibilityCheck, LogOverview, LoggedMotion, LoggedOdometry, MAX_SPEED, NamedRecordKind,
    ODOMETRY, ODOMETRY_SCALE_TOLERANCE, OVERVIEW_HEAD, OdometryRecordKind, RefusedRecord, RepeatedImageCheck,
    SCANS, TurnHistory, VELOCITY_TIMEOUT, check_overlap, check_velocity, motion_between,
    warn_of_ended_odometry, warn_of_no_odometry, without_odometry_delay,
};
pub use robot_drawing::{PathSegmentWriter, ellipse_drawing, write_pose, write_robot};
pub use system::{MOST_ESTIMATES, System};
pub use truth_warnings::{warn_of_large_errors, warn_of_no_overlap, warn_of_reference, warn_of_start};
pub use wayfix_evaluation::terminal::Stopwatch;
