use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::Data;

use crate::random::Streams;
use crate::world::World;

/// The truth at one millisecond.
#[derive(Clone, Copy)]
pub struct TrueState<'a> {
    /// Since the start.
    pub milliseconds: u64,
    /// Where the robot is.
    pub pose: Pose2<f64>,
    /// How far the left and right wheel have turned since the start, radians.
    pub wheel_angles: [f64; 2],
    /// What there is to see.
    pub world: &'a dyn World,
}

impl TrueState<'_> {
    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        self.milliseconds as f64 * 1e-3
    }
}

/// What a sensor gives to the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The measurement.
    pub data: Data,
    /// How much later than the moment it describes it is stamped, milliseconds; negative when stamped before.
    pub stamp_offset_ms: i64,
}

/// An instrument on the robot. Implement it to log something of your own: the driver calls it, stamps what it says and sorts it in.
///
/// **Laws**: with the same history and the same streams it says the same; it draws from `streams` only, and as many numbers whatever it
/// sees, so that two logs of one seed stay comparable.
pub trait Sensor {
    /// Time from one reading to the next, at least 1 ms; the first comes at the start.
    fn period_ms(&self) -> u32;

    /// What it says now; `None` when it says nothing.
    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut Streams) -> Option<Reading>;
}
