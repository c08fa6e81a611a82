use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::RecordData;

use crate::random::RandomStreams;
use crate::world::SensorWorld;

/// The truth at one millisecond.
#[derive(Clone, Copy)]
pub struct TrueState<'a> {
    /// Since the start.
    pub milliseconds: u64,
    /// Pose of the robot.
    pub pose: Pose2<f64>,
    /// Angles of the left and right wheel since the start, rad.
    pub wheel_angles: [f64; 2],
    /// The world.
    pub world: &'a dyn SensorWorld,
}

impl TrueState<'_> {
    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        self.milliseconds as f64 * 1e-3
    }
}

/// Output of a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorReading {
    /// The measurement.
    pub data: RecordData,
    /// Difference of the stamp from the measured moment, ms; negative for an early stamp.
    pub stamp_offset_ms: i64,
}

/// A sensor on the robot. Implement it for custom data: the simulation calls it, stamps its readings and sorts them into the log.
///
/// **Laws**: equal histories and equal streams give equal readings; it draws from `streams` only, and a fixed number of draws for any input, so
/// that two logs of one seed stay comparable.
pub trait SimulatedSensor {
    /// Period of the readings, at least 1 ms; the first comes at the start.
    fn period_ms(&self) -> u32;

    /// The current reading; `None` if there is none.
    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut RandomStreams) -> Option<SensorReading>;
}
