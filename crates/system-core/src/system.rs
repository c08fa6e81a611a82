use wayfix_sensor_log::{Record, RecordData};

use crate::EventCounts;

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
    /// Whether the pose at the stamp of this record matters. [`drive`](crate::drive) cuts an increment of odometry there, as motion between its stamps is even.
    fn cuts_odometry(_data: &RecordData) -> bool
    where
        Self: Sized,
    {
        false
    }
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
