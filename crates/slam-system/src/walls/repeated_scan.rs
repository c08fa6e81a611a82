use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::LaserScan;

/// Finds scans of a laser that hangs: every range equals that of the scan before, although the robot has moved.
#[derive(Clone, Debug, Default)]
pub(super) struct RepeatedScanCheck {
    ranges: Vec<f64>,
    /// Dead-reckoned pose at the first scan with these ranges.
    first: Option<Pose2<f64>>,
}

/// Motion that changes a scan, m: the resolution of common lasers.
const RESOLUTION: f64 = 0.01;

impl RepeatedScanCheck {
    /// Refuses a scan that repeats the last one although the robot has turned by more than a beam or moved by more than the resolution of a laser.
    pub(super) fn check(&mut self, scan: &LaserScan, dead_reckoning: &Pose2<f64>) -> Result<(), String> {
        let ranges = &scan.ranges;
        let is_same = ranges.len() == self.ranges.len()
            && ranges.iter().zip(&self.ranges).all(|(a, b)| a.to_bits() == b.to_bits())
            && scan.echoes().next().is_some();
        let Some(first) = self.first.filter(|_| is_same) else {
            self.ranges.clone_from(ranges);
            self.first = Some(*dead_reckoning);
            return Ok(());
        };
        let moved = first.inverse().compose(dead_reckoning);
        let (distance, turn) = (moved.translation.norm(), moved.heading().abs());
        if distance <= RESOLUTION && turn <= scan.angle_increment.abs() {
            return Ok(());
        }
        Err(format!(
            "it repeats the scan before, although odometry has moved by {distance:.2} m and {:.1}°: the laser hangs",
            turn.to_degrees()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_scan_is_refused_once_the_robot_has_moved() {
        let scan = |range: f64| LaserScan {
            ranges: vec![range, f64::NAN, 2.0],
            range_max: 8.0,
            angle_min: 0.0,
            angle_increment: 0.01,
            beam_period: 0.0,
        };
        let mut check = RepeatedScanCheck::default();
        let mut at =
            |scan: &LaserScan, x: f64, heading: f64| check.check(scan, &Pose2::new(x, 0.0, heading)).is_ok();
        assert!(at(&scan(1.0), 0.0, 0.0));
        assert!(at(&scan(1.0), 0.005, 0.0), "it stands");
        assert!(!at(&scan(1.0), 0.02, 0.0) && !at(&scan(1.0), 0.0, 0.02));
        assert!(at(&scan(1.1), 0.5, 0.0), "it works again");
        let nothing = LaserScan { ranges: vec![f64::INFINITY; 3], ..scan(1.0) };
        assert!(at(&nothing, 0.5, 0.0) && at(&nothing, 1.0, 0.0), "no echo in the open");
    }
}
