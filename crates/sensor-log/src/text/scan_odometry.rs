use wayfix_estimation_traits::{LieGroup, Pose2};

/// Finds the odometry between scans, also in logs corrected by a mapping program.
///
/// Such a program also writes the corrected pose into the odometry of the scan. A log corrected by GMapping then continues with `ODOM` lines from
/// there: each section between two scans begins at the corrected pose and ends, at the stamp of the next scan, at the pose of odometry
/// alone. That end is the odometry; if no `ODOM` line has the stamp of the scan, the scan's own pose is used.
#[derive(Default)]
pub(super) struct ScanOdometry {
    at_last_scan: Option<Pose2<f64>>,
    last_line: Option<(f64, Pose2<f64>)>,
}

impl ScanOdometry {
    /// An `ODOM` line and its time, seconds.
    pub(super) fn line(&mut self, seconds: f64, pose: Pose2<f64>) {
        self.last_line = Some((seconds, pose));
    }

    /// A scan with its odometry: the motion since the last scan, `None` at the first.
    pub(super) fn scan(&mut self, seconds: f64, odometry: Pose2<f64>) -> Option<Pose2<f64>> {
        let reached = self.reached(seconds, odometry);
        let start = self.at_last_scan.replace(odometry)?;
        Some(start.inverse().compose(&reached))
    }

    /// The odometry pose at a scan.
    pub(super) fn reached(&mut self, seconds: f64, odometry: Pose2<f64>) -> Pose2<f64> {
        match self.last_line.take() {
            Some((at, pose)) if at == seconds => pose,
            _ => odometry,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64) -> Pose2<f64> {
        Pose2::new(x, 0.0, 0.0)
    }

    #[test]
    fn corrections_are_no_motion() {
        let mut odometry = ScanOdometry::default();
        odometry.line(1.0, at(0.5));
        assert_eq!(odometry.scan(1.0, at(0.0)), None); // corrected by half a metre
        odometry.line(0.0, at(0.0));
        odometry.line(2.0, at(1.0));
        assert_eq!(odometry.scan(2.0, at(5.0)), Some(at(1.0))); // corrected by four
        odometry.line(0.0, at(5.0));
        odometry.line(3.0, at(5.25));
        assert_eq!(odometry.scan(3.0, at(4.0)), Some(at(0.25)));
    }

    #[test]
    fn without_a_line_at_the_scan_its_own_odometry_counts() {
        let mut odometry = ScanOdometry::default();
        odometry.scan(1.0, at(1.0));
        odometry.line(1.5, at(1.25));
        assert_eq!(odometry.scan(2.0, at(1.75)), Some(at(0.75)));
        assert_eq!(odometry.scan(3.0, at(1.5)), Some(at(-0.25)));
    }
}
