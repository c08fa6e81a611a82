use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_evaluation::errors::ReferencePath;
use wayfix_sensor_log::{Record, Stamp};

use crate::motion_between;

/// The true pose at the start of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueStartPose {
    /// The true pose at the start.
    pub pose: Pose2<f64>,
    /// Time from the start to the first true pose, s; odometry bridges it.
    pub seconds_late: f64,
}

impl TrueStartPose {
    /// The true pose at `at`. If truth begins later, odometry extrapolates its first pose back to `at`.
    ///
    /// Returns `None` if no truth is usable or odometry does not cover the interval.
    pub fn at(at: Stamp, truth: &ReferencePath, records: &[Record]) -> Option<Self> {
        if let Some(pose) = truth.at(at) {
            return Some(Self { pose, seconds_late: 0.0 });
        }
        let (stamp, pose) = truth.first_after(at)?;
        let moved = motion_between(records, at, stamp)?;
        Some(Self { pose: pose.compose(&moved.inverse()), seconds_late: stamp.seconds_since(at) })
    }
}
