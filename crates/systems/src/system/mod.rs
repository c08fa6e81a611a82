//! One way through: records in time order → a [`System`] → estimates, events and figures.

mod drive;
mod estimate_log;
mod events;
mod held_velocity;
mod known_start;
mod laser;
mod motion_statistics;
mod odometry_delay;
mod odometry_lag;
mod overlap;
mod plausible_increment;
mod stopwatch;

pub use drive::{DriveStep, drive};
pub use estimate_log::{Drawing, EstimateLog, EstimateWriter, OTHER_POSES};
pub use events::{Events, Refusal};
pub use held_velocity::{FASTEST, HeldMotion, HeldVelocity, VELOCITY_HOLD, check_velocity};
pub use known_start::KnownStart;
pub use laser::largest_echo;
pub use motion_statistics::MotionStatistics;
pub use odometry_delay::without_odometry_delay;
pub use odometry_lag::warn_of_lag;
pub use overlap::{NamedKind, ODOMETRY, check_overlap};
pub use plausible_increment::PlausibleIncrement;
pub use stopwatch::Stopwatch;

use wayfix_sensor_log::Record;

/// An estimator behind a log: takes the records it understands, in time order, and counts what happens.
///
/// **Laws**: a record that cannot be used changes nothing and is counted with its reason; the same records give the same bits.
pub trait System {
    /// Takes one record.
    ///
    /// # Errors
    /// Why the record was refused; the system is as it was before it.
    fn take(&mut self, record: &Record) -> Result<(), String>;
    /// Uses what waited for a later record; there is none.
    ///
    /// # Errors
    /// Why what waited could not be used.
    fn finish(&mut self) -> Result<(), String> {
        Ok(())
    }
    /// What has happened so far.
    fn events(&mut self) -> &mut Events;
}
