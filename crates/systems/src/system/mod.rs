//! The common pipeline: records in time order → a [`System`] → estimates, events and figures.

mod drive;
mod estimate_recorder;
mod estimate_sample;
mod known_start;
mod laser;
mod overview;
mod robot_drawing;

pub use drive::{RunStep, drive};
pub use estimate_recorder::{EstimateDrawer, EstimateRecorder, EstimateWriter, OTHER_POSES};
pub use estimate_sample::MOST_ESTIMATES;
pub(crate) use estimate_sample::note_of_sample;
pub use known_start::TrueStartPose;
pub use laser::largest_echo;
pub use overview::{LogOverview, OVERVIEW_HEAD};
pub(crate) use robot_drawing::{PathPieces, ellipse, write_pose, write_robot};
pub use wayfix_evaluation::terminal::Stopwatch;
pub use wayfix_record_checks::{
    EventCounts, FASTEST, HeadingSignTest, HeldVelocity, HeldVelocityMotion, IncrementPlausibilityCheck,
    NamedRecordKind, ODOMETRY, RefusedRecord, TurnHistory, VELOCITY_TIMEOUT, check_overlap, check_velocity,
    without_odometry_delay,
};
pub use wayfix_slam_ekf::MotionStatistics;

use wayfix_sensor_log::Record;

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
