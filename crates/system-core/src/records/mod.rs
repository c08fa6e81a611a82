//! Checks of the records of a log before a filter takes them, and the events that count what is refused.

mod cut_odometry;
mod events;
mod heading_sign;
mod held_velocity;
mod logged_odometry;
mod motion_between;
mod odometry_delay;
mod odometry_lag;
mod overlap;
mod overview;
mod plausible_increment;
mod repeated_image;
mod turn_scale;

pub(crate) use cut_odometry::CutOdometry;
pub use events::{EventCounts, RefusedRecord};
pub use heading_sign::HeadingSignTest;
pub use held_velocity::{HeldVelocity, HeldVelocityMotion, MAX_SPEED, VELOCITY_TIMEOUT, check_velocity};
pub use logged_odometry::{LoggedMotion, LoggedOdometry, ODOMETRY_SCALE_TOLERANCE, OdometryRecordKind};
pub use motion_between::motion_between;
pub use odometry_delay::without_odometry_delay;
pub use odometry_lag::TurnHistory;
pub use overlap::{
    DETECTIONS, IMAGES, NamedRecordKind, ODOMETRY, SCANS, check_overlap, warn_of_ended_odometry,
    warn_of_no_odometry,
};
pub use overview::{LogOverview, OVERVIEW_HEAD};
pub use plausible_increment::IncrementPlausibilityCheck;
pub use repeated_image::RepeatedImageCheck;
