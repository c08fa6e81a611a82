//! Agreement of two rows of poses.

use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};

use super::row::ScanPoses;

/// Two equal poses that are printed with three decimals are nearer: x, y and heading are rounded twice by half of the last one, m and rad.
const SAME: f64 = 2e-3;

pub(super) fn is_same(a: &Pose2<f64>, b: &Pose2<f64>) -> bool {
    a.local(b).norm() < SAME
}

/// The pose that all are, but for single ones.
pub(super) fn common(poses: &[Pose2<f64>]) -> Option<Pose2<f64>> {
    let candidate = majority(poses)?;
    (!lasts(poses.iter().map(|pose| !is_same(&candidate, pose)))).then_some(candidate)
}

/// Whether two in succession hold: one alone is a bad row.
pub(super) fn lasts(holds: impl Iterator<Item = bool>) -> bool {
    let mut last = false;
    holds.into_iter().any(|now| std::mem::replace(&mut last, now) && now)
}

/// Whether the laser's poses are those of odometry in another world frame.
pub(super) fn is_shifted(poses: &[ScanPoses]) -> bool {
    let frames: Vec<_> = poses.iter().map(|poses| poses.laser.compose(&poses.odometry.inverse())).collect();
    common(&frames).is_some()
}

/// The pose that more than half of all are, if one is; else any. [Boyer & Moore 1991]
fn majority(poses: &[Pose2<f64>]) -> Option<Pose2<f64>> {
    let mut candidate = *poses.first()?;
    let mut lead = 0_u64;
    for pose in poses {
        if lead == 0 {
            candidate = *pose;
        }
        lead = if is_same(&candidate, pose) { lead + 1 } else { lead - 1 };
    }
    Some(candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64) -> Pose2<f64> {
        Pose2::new(x, 0.0, std::f64::consts::PI)
    }

    #[test]
    fn single_bad_poses_do_not_hide_what_all_others_are() {
        assert_eq!(common(&[]), None);
        let mount = common(&[at(1e9), at(0.4), at(0.4), at(1e9), at(0.4005), at(0.4)]);
        assert!(mount.is_some_and(|mount| is_same(&mount, &at(0.4))), "{mount:?}");
        assert_eq!(common(&[at(0.4), at(0.4), at(0.4), at(0.5), at(0.6)]), None);
        let half_turn = std::f64::consts::PI;
        let printed_twice = [-half_turn, half_turn - 1e-6].map(|heading| Pose2::new(0.4, 0.0, heading));
        assert!(common(&printed_twice).is_some());
    }

    #[test]
    fn odometry_in_another_frame_is_shifted() {
        let frame = Pose2::new(3.0, -2.0, 1.0);
        let poses = |k: u32| {
            let odometry = Pose2::new(f64::from(k), 1.0, 0.1 * f64::from(k));
            ScanPoses { laser: frame.compose(&odometry), odometry }
        };
        let mut drive: Vec<ScanPoses> = (0..20).map(poses).collect();
        assert!(is_shifted(&drive));
        drive[10..].iter_mut().for_each(|poses| poses.laser = poses.laser.compose(&at(0.5)));
        assert!(!is_shifted(&drive));
    }
}
