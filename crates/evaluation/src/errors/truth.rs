use nalgebra::Matrix3;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_sensor_log::{Record, RecordData, Stamp};

use super::{PoseWithTruth, stamped_truth::StampedTruth, truth_noise::truth_noise};

/// Reference poses over time: true ones, or estimates of another program.
#[derive(Clone, Debug, Default)]
pub struct ReferencePath {
    poses: StampedTruth<Pose2<f64>>,
    noise: Matrix3<f64>,
    is_estimate: bool,
}

/// Longest interval over which truth is interpolated, s; motion capture and GPS have gaps.
pub const LONGEST_GAP: f64 = 0.5;

impl ReferencePath {
    /// The true poses among `records`; skips those that are not finite or go back in time.
    pub fn from_records(records: &[Record]) -> Self {
        Self::of_kind(false, records)
    }

    /// The true poses, or, if the log has none, the estimates of another program.
    pub fn from_records_or_estimates(records: &[Record]) -> Self {
        let truth = Self::from_records(records);
        if !truth.is_empty() {
            return truth;
        }
        let track = Self::of_kind(true, records);
        Self { is_estimate: !track.is_empty(), ..track }
    }

    fn of_kind(is_estimate: bool, records: &[Record]) -> Self {
        let mut path = Self { is_estimate, ..Self::default() };
        records.iter().for_each(|record| path.push(record));
        path.noise = truth_noise(path.poses.values(), records);
        path
    }

    fn push(&mut self, record: &Record) {
        match record.data {
            RecordData::TruePose(pose) if !self.is_estimate && pose.is_finite() => {
                self.poses.push(record.stamp, pose);
            }
            RecordData::EstimatedPose(pose) if self.is_estimate && pose.is_finite() => {
                self.poses.push(record.stamp, pose);
            }
            _ => {}
        }
    }

    /// The path before the first record of its log: [`take`](Self::take) gives it the poses.
    pub fn restarted(&self) -> Self {
        Self { poses: StampedTruth::default(), ..*self }
    }

    /// Takes the next record of a log. Of a long log only poses around the stamps of `estimates` are kept, which are those so far.
    pub fn take(&mut self, record: &Record, estimates: impl Iterator<Item = Stamp>) {
        self.push(record);
        self.poses.thin(record.stamp, estimates);
    }

    /// Covariance of the errors of the truth, `(x, y, θ)` in the body frame; zero if the log does not reveal any.
    pub fn noise(&self) -> &Matrix3<f64> {
        &self.noise
    }

    /// Whether the poses are estimates of another program, with unknown errors.
    pub fn is_estimate(&self) -> bool {
        self.is_estimate
    }

    /// Whether there are no poses.
    pub fn is_empty(&self) -> bool {
        self.poses.values().is_empty()
    }

    /// Pairs an estimate with the truth at its stamp. Adds the noise of the truth to the covariance.
    pub fn sample(
        &self,
        stamp: Stamp,
        estimate: Pose2<f64>,
        covariance: &Matrix3<f64>,
    ) -> Option<PoseWithTruth> {
        let truth = self.at(stamp)?;
        Some(PoseWithTruth { estimate, covariance: covariance + self.noise, truth })
    }

    /// Last stamp with a true pose.
    pub fn last_stamp(&self) -> Option<Stamp> {
        self.poses.values().last().map(|(stamp, _)| *stamp)
    }

    /// The first true pose at or after a stamp.
    pub fn first_after(&self, stamp: Stamp) -> Option<(Stamp, Pose2<f64>)> {
        self.poses.values().get(self.poses.at_or_after(stamp)).copied()
    }

    /// First and last stamp with a true pose.
    pub fn span(&self) -> Option<(Stamp, Stamp)> {
        Some((self.poses.values().first()?.0, self.last_stamp()?))
    }

    /// The pose at `stamp`: interpolated linearly, headings along the shorter arc, never across more than half a second.
    pub fn at(&self, stamp: Stamp) -> Option<Pose2<f64>> {
        let (after, poses) = (self.poses.at_or_after(stamp), self.poses.values());
        let (late, late_pose) = poses.get(after)?;
        if *late == stamp {
            return Some(*late_pose);
        }
        let (early, early_pose) = poses.get(after.checked_sub(1)?)?;
        let gap = late.seconds_since(*early);
        if gap > LONGEST_GAP {
            return None;
        }
        let fraction = stamp.seconds_since(*early) / gap;
        let position = early_pose.translation.lerp(&late_pose.translation, fraction);
        let turn = early_pose.rotation.local(&late_pose.rotation) * fraction;
        Some(Pose2 { translation: position, rotation: early_pose.rotation.retract(&turn) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn track(rows: &[(u64, f64)]) -> ReferencePath {
        let record = |&(milliseconds, heading): &(u64, f64)| Record {
            stamp: Stamp::from_nanoseconds(milliseconds * 1_000_000),
            data: RecordData::TruePose(Pose2::new(milliseconds as f64, 0.0, heading)),
        };
        ReferencePath::from_records(&rows.iter().map(record).collect::<Vec<_>>())
    }

    #[test]
    fn interpolates_along_the_shorter_arc_and_not_across_gaps() {
        let track = track(&[(0, 3.1), (100, -3.1), (1000, 0.0)]);
        let at = |milliseconds: u64| track.at(Stamp::from_nanoseconds(milliseconds * 1_000_000));
        let middle = at(50).unwrap();
        assert_abs_diff_eq!(middle.heading().abs(), std::f64::consts::PI, epsilon = 1e-12);
        assert_abs_diff_eq!(middle.x(), 50.0, epsilon = 1e-12);
        assert_eq!(at(0).unwrap().heading(), 3.1);
        assert_eq!(at(500), None);
        assert_eq!(at(1000).unwrap().heading(), 0.0);
        assert_eq!(at(1001), None);
    }

    #[test]
    fn leaves_out_what_goes_back_in_time() {
        let track = track(&[(0, 0.0), (200, 0.2), (100, 3.0), (300, 0.3)]);
        assert_abs_diff_eq!(
            track.at(Stamp::from_nanoseconds(100_000_000)).unwrap().heading(),
            0.1,
            epsilon = 1e-12
        );
    }
}
