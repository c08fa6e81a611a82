use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::Stamp;
use wayfix_slam_smoother::range_only::{Range, RangeOnlyInput};
use wayfix_system_core::EventCounts;
use wayfix_table_log::RangeRecording;

/// A recording as poses at the stamps of its ranges, with the motions between them.
pub(super) struct StampedInput {
    /// Stamps of the poses.
    pub(super) stamps: Vec<Stamp>,
    pub(super) input: RangeOnlyInput,
}

impl StampedInput {
    /// The first pose is `start`, at the first row of odometry. Ranges that cannot be used are counted.
    pub(super) fn new(recording: &RangeRecording, start: Pose2<f64>, events: &mut EventCounts) -> Self {
        let begin = recording.odometry.first().map_or(Stamp::default(), |(stamp, _)| *stamp);
        let end = recording.odometry.last().map_or(Stamp::default(), |(stamp, _)| *stamp);
        let mut stamps = vec![begin];
        let mut input = RangeOnlyInput { start, motions: Vec::new(), ranges: Vec::new() };
        let mut odometry = Interpolator { rows: &recording.odometry, next: 1, at: begin };
        for (index, row) in recording.ranges.iter().enumerate() {
            events.at_record(index, row.stamp);
            if row.stamp < begin {
                events.count("record_before_start");
            } else if row.stamp > end {
                events.count("record_after_odometry");
            } else if !(row.range > 0.0 && row.range.is_finite()) {
                events.refuse("observation_unusable", format!("a range of {} m is not usable", row.range));
            } else {
                if stamps.last().is_some_and(|last| *last < row.stamp) {
                    stamps.push(row.stamp);
                    input.motions.push(odometry.motion_to(row.stamp));
                }
                let pose = stamps.len() - 1;
                input.ranges.push(Range { pose, beacon: row.beacon, range: row.range });
            }
        }
        Self { stamps, input }
    }
}

/// Motion between two times by rows that lead from stamp to stamp; a part of a row counts in proportion to time.
struct Interpolator<'a> {
    rows: &'a [(Stamp, Pose2<f64>)],
    /// The row that leads on from `at`.
    next: usize,
    at: Stamp,
}

impl Interpolator<'_> {
    fn motion_to(&mut self, stamp: Stamp) -> Pose2<f64> {
        let mut motion = Pose2::identity();
        while let Some((end, row)) = self.rows.get(self.next).filter(|_| self.at < stamp) {
            let begin = self.rows[self.next - 1].0;
            let until = (*end).min(stamp);
            // Rows of equal stamps follow each other at once.
            let duration = end.seconds_since(begin);
            let share = if duration > 0.0 { until.seconds_since(self.at) / duration } else { 1.0 };
            motion = motion.compose(&Pose2::exp(&(row.log() * share)));
            self.at = until;
            if until == *end {
                self.next += 1;
            }
        }
        motion
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> Stamp {
        Stamp::from_seconds(seconds).unwrap()
    }

    #[test]
    fn parts_of_rows_add_up_to_the_rows() {
        let rows = [0.0, 1.0, 2.0, 2.0, 4.0].map(|t| (at(t), Pose2::new(t, 0.1, 0.3)));
        let mut odometry = Interpolator { rows: &rows, next: 1, at: rows[0].0 };
        let parts = [0.25, 0.9, 1.5, 2.0, 3.0, 4.0].map(|t| odometry.motion_to(at(t)));
        let whole = rows[1..].iter().fold(Pose2::identity(), |sum, (_, row)| sum.compose(row));
        let sum = parts.iter().fold(Pose2::identity(), |sum, part| sum.compose(part));
        assert!(sum.inverse().compose(&whole).log().norm() < 1e-12, "{sum:?} {whole:?}");
        assert_eq!(odometry.motion_to(at(9.0)), Pose2::identity());
    }
}
