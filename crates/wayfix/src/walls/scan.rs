use wayfix_estimation_traits::Pose2;
use wayfix_scan_match::Cloud;
use wayfix_sensor_log::{LaserScan, Stamp};

use crate::system::largest_echo;

/// A scan that waits for the odometry that leads up to it, and where the laser was.
pub(super) struct WaitingScan {
    pub(super) stamp: Stamp,
    pub(super) scan: LaserScan,
    pub(super) laser: Pose2<f64>,
}

/// A scan that walls were taken from.
pub(super) struct Look {
    pub(super) scan: LaserScan,
    pub(super) laser: Pose2<f64>,
    pub(super) cloud: Cloud,
}

/// The points of a scan in the frame of the robot.
pub(super) fn cloud_of(scan: &LaserScan, mount: &Pose2<f64>) -> Result<Cloud, String> {
    let LaserScan { angle_min, angle_increment, ranges, .. } = scan;
    let cloud = Cloud::from_ranges(*angle_min, *angle_increment, ranges, largest_echo(scan));
    cloud.map(|cloud| cloud.carried_at(mount)).map_err(|error| error.to_string())
}
