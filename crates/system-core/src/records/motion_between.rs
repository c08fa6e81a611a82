use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{Record, RecordData, Stamp};

use crate::HeldVelocity;

/// Motion between two times from the odometry of a log; `None` without odometry.
pub fn motion_between(records: &[Record], from: Stamp, to: Stamp) -> Option<Pose2<f64>> {
    let has_increments = records.iter().any(|record| matches!(record.data, RecordData::OdometryIncrement(_)));
    if has_increments { by_increments(records, from, to) } else { by_velocities(records, from, to) }
}

/// An increment partly outside the interval counts in proportion to time.
fn by_increments(records: &[Record], from: Stamp, to: Stamp) -> Option<Pose2<f64>> {
    let mut moved = Pose2::identity();
    let mut before: Option<Stamp> = None;
    for record in records {
        let RecordData::OdometryIncrement(increment) = &record.data else { continue };
        let begin = before.replace(record.stamp).unwrap_or(from);
        let whole = record.stamp.seconds_since(begin);
        let inside = record.stamp.min(to).seconds_since(begin.max(from));
        if whole > 0.0 && inside > 0.0 && increment.is_finite() {
            moved = moved.compose(&Pose2::exp(&(increment.log() * (inside / whole))));
        }
    }
    before.map(|_| moved)
}

fn by_velocities(records: &[Record], from: Stamp, to: Stamp) -> Option<Pose2<f64>> {
    let mut held = HeldVelocity::default();
    let mut moved = None;
    for record in records {
        let RecordData::Velocity(velocity) = record.data else { continue };
        if record.stamp >= to {
            break;
        }
        let motion = held.motion_until(record.stamp.max(from), f64::INFINITY);
        let so_far = moved.get_or_insert(Pose2::identity());
        if let Some(motion) = motion {
            *so_far = so_far.compose(&motion.increment);
        }
        if held.hold(record.stamp, velocity).is_ok() && record.stamp < from {
            let _ = held.motion_until(from, f64::INFINITY); // skip the motion before the interval
        }
    }
    let rest = held.motion_until(to, f64::INFINITY);
    moved.map(|moved| rest.map_or(moved, |rest| moved.compose(&rest.increment)))
}
