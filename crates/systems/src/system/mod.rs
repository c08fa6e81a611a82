//! The common pipeline: records in time order → a [`System`] → estimates, events and figures.

mod drive;
mod estimate_recorder;
mod known_start;
mod laser;
mod robot_drawing;

pub use drive::{RunStep, drive};
pub use estimate_recorder::{EstimateDrawer, EstimateRecorder, EstimateWriter, OTHER_POSES};
pub use known_start::TrueStartPose;
pub use laser::largest_echo;
pub(crate) use robot_drawing::{PathPieces, ellipse, write_pose, write_robot};
pub use wayfix_evaluation::terminal::Stopwatch;
pub use wayfix_record_checks::{
    EventCounts, FASTEST, HeadingSignTest, HeldVelocity, HeldVelocityMotion, IncrementPlausibilityCheck,
    LogOverview, NamedRecordKind, ODOMETRY, OVERVIEW_HEAD, RefusedRecord, TurnHistory, VELOCITY_TIMEOUT,
    check_overlap, check_velocity, without_odometry_delay,
};
pub use wayfix_slam_ekf::MotionStatistics;

use wayfix_sensor_log::Record;

/// Estimates that a run keeps for figures and pictures: two hours at 9 Hz.
pub const MOST_ESTIMATES: usize = 1 << 16;

/// An estimator that processes a log: takes the records that it supports, in time order, and counts events.
///
/// **Laws**: a record that cannot be used changes nothing and is counted with its reason; equal records give equal bits.
pub trait System {
    /// Takes one record.
    ///
    /// # Errors
    /// Returns the reason if the record is rejected; the system state is unchanged.
    fn take(&mut self, record: &Record) -> Result<(), String>;
    /// Processes data that waits for a later record, at the end of the log.
    ///
    /// # Errors
    /// Returns the reason if that data cannot be used.
    fn finish(&mut self) -> Result<(), String> {
        Ok(())
    }
    /// Events so far.
    fn events(&mut self) -> &mut EventCounts;
}
