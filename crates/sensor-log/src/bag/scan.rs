use wayfix_estimation_traits::{Pose2, Pose3};

use crate::LaserScan;
use crate::fault::{Fault, finite, inconsistent};
use crate::planar::heading_of;
use crate::ros;

/// Maximum tilt of a laser, degrees; with more tilt it measures the floor or the sky.
const MAX_TILT_DEG: f64 = 20.0;

/// Pose of a laser on the robot, in the ground plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mount {
    pub(super) pose: Pose2<f64>,
    is_upside_down: bool,
}

impl Mount {
    pub(super) fn of(laser: &Pose3<f64>) -> Result<Self, Fault> {
        let up = (laser.rotation * nalgebra::Vector3::z()).z;
        if up.abs() < MAX_TILT_DEG.to_radians().cos() {
            let tilt = libm::acos(up.abs().min(1.0)).to_degrees();
            return Err(inconsistent(&format!(
                "the laser is tilted by {tilt:.0}°, it does not scan the plane"
            )));
        }
        let q = laser.rotation;
        let heading = heading_of([q.i, q.j, q.k, q.w]);
        let pose = Pose2::new(laser.translation.x, laser.translation.y, heading);
        Ok(Self { pose, is_upside_down: up < 0.0 })
    }
}

/// The scan with directions in the robot frame; those of a laser mounted upside down are reversed.
pub(super) fn scan(message: &ros::LaserScan<'_>, mount: Option<&Mount>) -> Result<LaserScan, Fault> {
    let [angle_min, angle_increment] = [message.angle_min, message.angle_increment].map(f64::from);
    finite([angle_min, angle_increment])?;
    if angle_increment == 0.0 && message.ranges.len() > 1 {
        return Err(inconsistent("scan whose beams all have the same direction"));
    }
    let turn = if mount.is_some_and(|mount| mount.is_upside_down) { -1.0 } else { 1.0 };
    let (range_min, range_max) = limits(message);
    let in_limits = |range: f32| if range < range_min { f64::NAN } else { f64::from(range) };
    Ok(LaserScan {
        angle_min: turn * angle_min,
        angle_increment: turn * angle_increment,
        range_max,
        beam_period: beam_period(message),
        ranges: message.ranges.iter().copied().map(in_limits).collect(),
    })
}

/// The time between beams; 0, unknown, if it is invalid.
fn beam_period(message: &ros::LaserScan<'_>) -> f64 {
    Some(message.time_increment).filter(|period| period.is_finite() && *period > 0.0).map_or(0.0, f64::from)
}

/// The range limits of a scan; limits that exclude all ranges are ignored.
fn limits(message: &ros::LaserScan<'_>) -> (f32, f64) {
    let min = if message.range_min.is_nan() { 0.0 } else { message.range_min };
    let max = if message.range_max > 0.0 { f64::from(message.range_max) } else { f64::INFINITY };
    if f64::from(min) < max { (min, max) } else { (0.0, f64::INFINITY) }
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use nalgebra::{UnitQuaternion, Vector2, Vector3};

    use super::*;

    #[test]
    fn time_from_beam_to_beam_is_kept_and_nonsense_is_unknown() {
        for (stated, kept) in [(0.25, 0.25), (0.0, 0.0), (-1.0, 0.0), (f32::NAN, 0.0), (f32::INFINITY, 0.0)] {
            let message = ros::LaserScan { time_increment: stated, ..message(vec![1.0]) };
            assert_eq!(scan(&message, None).unwrap().beam_period, kept, "{stated}");
        }
    }

    fn message(ranges: Vec<f32>) -> ros::LaserScan<'static> {
        ros::LaserScan {
            header: ros::Header::default(),
            angle_min: -0.5,
            angle_max: 0.5,
            angle_increment: 0.25,
            time_increment: 0.0,
            scan_time: 0.0,
            range_min: 0.125,
            range_max: 8.0,
            ranges,
            intensities: Vec::new(),
        }
    }

    #[test]
    fn what_is_outside_the_limits_is_no_echo() {
        let scan = scan(&message(vec![0.1, 2.0, f32::INFINITY, f32::NAN, 8.0]), None).unwrap();
        assert_eq!(scan.echoes().collect::<Vec<_>>(), [(-0.25, 2.0)]);
        assert_eq!(scan.ranges.len(), 5);
    }

    #[test]
    fn a_limit_of_nothing_is_none() {
        for range_max in [0.0, -1.0, f32::NAN] {
            let message = ros::LaserScan { range_max, ..message(vec![90.0]) };
            assert_eq!(scan(&message, None).unwrap().range_max, f64::INFINITY);
        }
    }

    #[test]
    fn a_laser_head_down_sees_the_point_where_its_rotation_says() {
        let rotation = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.75);
        let laser = Pose3 { translation: Vector3::new(0.5, -0.25, 1.0), rotation };
        let mount = Mount::of(&laser).unwrap();
        let scan = scan(&message(vec![2.0]), Some(&mount)).unwrap();
        let (bearing, range) = scan.echoes().next().unwrap();
        let seen = mount.pose.transform(&Vector2::new(range * bearing.cos(), range * bearing.sin()));
        let (sin, cos) = (-0.5_f64).sin_cos();
        let expected = rotation * Vector3::new(2.0 * cos, 2.0 * sin, 0.0) + laser.translation;
        assert!(abs_diff_eq!(seen, expected.xy(), epsilon = 1e-12), "{seen} {expected}");
    }

    #[test]
    fn a_laser_that_looks_at_the_floor_is_refused() {
        let rotation = UnitQuaternion::from_euler_angles(0.0, 1.5, 0.0);
        let laser = Pose3 { translation: Vector3::zeros(), rotation };
        assert!(Mount::of(&laser).unwrap_err().1.contains("tilted by 86°"));
    }
}
