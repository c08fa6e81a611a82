use std::borrow::Cow;

use wayfix_sensor_log::{Record, Stamp};

use crate::ODOMETRY;

/// The records of a log with the odometry stamped `delay` seconds earlier, sorted by time.
///
/// A delay of 0 changes nothing; a negative delay moves odometry to later stamps.
pub fn without_odometry_delay(records: &[Record], delay: f64) -> Cow<'_, [Record]> {
    if delay == 0.0 {
        return Cow::Borrowed(records);
    }
    let delay = (delay * 1e9) as i64;
    let (_, is_odometry) = ODOMETRY;
    let shifted = |record: &Record| {
        let mut record = record.clone();
        if is_odometry(&record.data) {
            let nanoseconds = i128::from(record.stamp.nanoseconds()) - i128::from(delay);
            record.stamp = Stamp::from_nanoseconds(nanoseconds.clamp(0, u64::MAX.into()) as u64);
        }
        record
    };
    let mut records: Vec<Record> = records.iter().map(shifted).collect();
    // At equal stamps, motion precedes observations.
    records.sort_by_key(|record| (record.stamp, !is_odometry(&record.data)));
    Cow::Owned(records)
}

#[cfg(test)]
mod tests {
    use wayfix_estimation_traits::Pose2;
    use wayfix_sensor_log::RecordData;

    use super::*;

    fn at(milliseconds: u64, data: RecordData) -> Record {
        Record { stamp: Stamp::from_nanoseconds(milliseconds * 1_000_000), data }
    }

    #[test]
    fn late_odometry_moves_before_the_records_of_its_time() {
        let odometry =
            |milliseconds| at(milliseconds, RecordData::OdometryIncrement(Pose2::new(1.0, 0.0, 0.0)));
        let look = at(800, RecordData::Detections(Vec::new()));
        let log = [odometry(100), look.clone(), odometry(1000)];
        assert!(matches!(without_odometry_delay(&log, 0.0), Cow::Borrowed(_)));
        assert_eq!(without_odometry_delay(&log, 0.25).as_ref(), [odometry(0), odometry(750), look.clone()]);
        assert_eq!(without_odometry_delay(&log, -0.8).as_ref(), [look, odometry(900), odometry(1800)]);
    }
}
