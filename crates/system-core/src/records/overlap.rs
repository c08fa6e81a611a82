use anyhow::{Result, bail};
use wayfix_sensor_log::{Record, RecordData, Stamp};

use crate::{EventCounts, VELOCITY_TIMEOUT};

/// A kind of record, for messages.
pub type NamedRecordKind<'a> = (&'a str, fn(&RecordData) -> bool);

/// Records that move a robot.
pub const ODOMETRY: NamedRecordKind<'static> = ("odometry", |data| {
    matches!(data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_) | RecordData::Ackermann(_))
});

/// Warns if a log has no increments and no velocities; `then` says what the system assumes.
pub fn warn_of_no_odometry(events: &mut EventCounts, records: &[Record], then: &str) {
    let moves =
        |record: &Record| matches!(record.data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_));
    if !records.iter().any(moves) {
        events.warn("no_odometry", format!("the log has neither odometry increments nor velocities: {then}"));
    }
}

/// Checks that two kinds of record overlap in time, if a log has both.
///
/// # Errors
/// Returns both intervals if they are disjoint: the records come from different clocks or drives.
pub fn check_overlap(
    records: &[Record],
    first: NamedRecordKind<'_>,
    second: NamedRecordKind<'_>,
) -> Result<()> {
    let (Some(a), Some(b)) = (span(records, first.1), span(records, second.1)) else { return Ok(()) };
    // A velocity also covers the time after it.
    if a.0.seconds_since(b.1) <= VELOCITY_TIMEOUT && b.0.seconds_since(a.1) <= VELOCITY_TIMEOUT {
        return Ok(());
    }
    bail!(
        "{} ({} to {}) and {} ({} to {}) have no time in common: are they of the same clock (use_sim_time)?",
        first.0,
        a.0,
        a.1,
        second.0,
        b.0,
        b.1
    )
}

fn span(records: &[Record], is: fn(&RecordData) -> bool) -> Option<(Stamp, Stamp)> {
    let mut stamps = records.iter().filter(|record| is(&record.data)).map(|record| record.stamp);
    let first = stamps.next()?;
    Some(stamps.fold((first, first), |(low, high), stamp| (low.min(stamp), high.max(stamp))))
}

#[cfg(test)]
mod tests {
    use wayfix_estimation_traits::Pose2;
    use wayfix_sensor_log::Velocity;

    use super::*;

    const TRUTH: NamedRecordKind<'static> = ("truth", |data| matches!(data, RecordData::TruePose(_)));

    fn records(odometry: u64, truth: u64) -> Vec<Record> {
        let velocity = RecordData::Velocity(Velocity { linear: 0.1, angular: 0.0 });
        let at = |second: u64, data: &RecordData| Record {
            stamp: Stamp::from_nanoseconds(second * 1_000_000_000),
            data: data.clone(),
        };
        let truth_data = RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0));
        vec![
            at(odometry, &velocity),
            at(odometry + 5, &velocity),
            at(truth, &truth_data),
            at(truth + 5, &truth_data),
        ]
    }

    #[test]
    fn disjoint_kinds_are_refused_with_both_intervals() {
        let error = check_overlap(&records(100, 7), ODOMETRY, TRUTH).unwrap_err().to_string();
        assert!(error.contains("100.0") && error.contains("12.0"), "{error}");
    }

    #[test]
    fn overlapping_and_missing_kinds_are_accepted() {
        assert!(check_overlap(&records(3, 7), ODOMETRY, TRUTH).is_ok());
        assert!(check_overlap(&records(3, 7)[..2], ODOMETRY, TRUTH).is_ok());
    }
}
