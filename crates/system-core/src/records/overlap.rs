use anyhow::{Result, bail};
use wayfix_sensor_log::{Record, RecordData, Stamp};

use crate::{EventCounts, VELOCITY_TIMEOUT};

/// A kind of record, for messages.
pub type NamedRecordKind<'a> = (&'a str, fn(&RecordData) -> bool);

/// Records that move a robot.
pub const ODOMETRY: NamedRecordKind<'static> = ("odometry", |data| {
    matches!(data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_) | RecordData::Ackermann(_))
});

/// Camera images.
pub const IMAGES: NamedRecordKind<'static> = ("images", |data| matches!(data, RecordData::Image(_)));
/// Laser scans.
pub const SCANS: NamedRecordKind<'static> = ("laser scans", |data| matches!(data, RecordData::Scan(_)));
/// Detections of landmarks.
pub const DETECTIONS: NamedRecordKind<'static> =
    ("detections", |data| matches!(data, RecordData::Detections(_)));

/// Warns if a log has no increments and no velocities; `then` says what the system assumes.
pub fn warn_of_no_odometry(events: &mut EventCounts, records: &[Record], then: &str) {
    let moves =
        |record: &Record| matches!(record.data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_));
    if !records.iter().any(moves) {
        events.warn("no_odometry", format!("the log has neither odometry increments nor velocities: {then}"));
    }
}

/// Warns if the increments that move a robot end before the last record of a sensor, by more than the time-out and twice their median period; `then` says what the system
/// assumes. Velocities are said where they expire.
pub fn warn_of_ended_odometry(
    events: &mut EventCounts,
    records: &[Record],
    sensor: NamedRecordKind<'_>,
    then: &str,
) {
    let moves =
        |record: &&Record| matches!(record.data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_));
    let first = records.iter().find(moves).map(|record| &record.data);
    let is_increment = |data: &RecordData| matches!(data, RecordData::OdometryIncrement(_));
    if !first.is_some_and(is_increment) {
        return;
    }
    let Some(((_, end), (_, last))) = span(records, is_increment).zip(span(records, sensor.1)) else {
        return;
    };
    let increments: Vec<&Record> = records.iter().filter(|record| is_increment(&record.data)).collect();
    let mut periods: Vec<f64> =
        increments.windows(2).map(|pair| pair[1].stamp.seconds_since(pair[0].stamp)).collect();
    periods.sort_by(f64::total_cmp);
    let period = periods.get(periods.len() / 2).copied().unwrap_or_default();
    let missing = last.seconds_since(end);
    if missing > VELOCITY_TIMEOUT.max(2.0 * period) {
        let (name, _) = sensor;
        events.warn(
            "odometry_ends_early",
            format!("odometry ends {missing:.1} s before the last of the {name}: {then} in that time"),
        );
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

fn span(records: &[Record], is: impl Fn(&RecordData) -> bool) -> Option<(Stamp, Stamp)> {
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

    #[test]
    fn increments_that_end_early_are_said() {
        let increment = RecordData::OdometryIncrement(Pose2::new(0.1, 0.0, 0.0));
        let velocity = RecordData::Velocity(Velocity { linear: 0.1, angular: 0.0 });
        let truth = RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0));
        let at = |second: u64, data: &RecordData| Record {
            stamp: Stamp::from_nanoseconds(second * 1_000_000_000),
            data: data.clone(),
        };
        let is_said = |records: &[Record]| {
            let mut events = EventCounts::default();
            warn_of_ended_odometry(&mut events, records, TRUTH, "the robot is taken to stand");
            events.get("odometry_ends_early") == 1
        };
        let log = |odometry: &RecordData, period: u64| -> Vec<Record> {
            let motions = (0..5).map(|step| at(period * step, odometry));
            motions.chain([at(4 * period + 6, &truth)]).collect()
        };
        assert!(is_said(&log(&increment, 1)));
        assert!(!is_said(&log(&increment, 5)), "slower odometry");
        assert!(!is_said(&log(&velocity, 1)), "said where it expires");
        let mut both = log(&increment, 1);
        both.push(at(10, &velocity));
        assert!(is_said(&both), "velocities that nobody follows");
        assert!(!is_said(&[]));
    }
}
