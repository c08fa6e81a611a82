use wayfix_estimation_traits::{Manifold, Pose2};

/// Poses of the odometry over time, seconds.
#[derive(Default)]
pub(super) struct Trajectory {
    poses: Vec<(f64, Pose2<f64>)>,
}

impl Trajectory {
    /// Adds a pose; skips one that is earlier than the previous one.
    pub(super) fn push(&mut self, seconds: f64, pose: Pose2<f64>) {
        if self.poses.last().is_none_or(|(last, _)| *last < seconds) {
            self.poses.push((seconds, pose));
        }
    }

    /// The pose at a time: interpolated, the nearest beyond the ends; `None` without poses.
    pub(super) fn at(&self, seconds: f64) -> Option<Pose2<f64>> {
        let after = self.poses.partition_point(|(at, _)| *at < seconds);
        let before = after.checked_sub(1).and_then(|index| self.poses.get(index));
        match (before, self.poses.get(after)) {
            (Some((early, from)), Some((late, to))) => {
                let fraction = (seconds - early) / (late - early);
                Some(from.retract(&(from.local(to) * fraction)))
            }
            (before, after) => before.or(after).map(|(_, pose)| *pose),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_interpolated_between_its_neighbours() {
        let mut trajectory = Trajectory::default();
        assert!(trajectory.at(1.0).is_none());
        for (seconds, x) in [(1.0, 0.0), (3.0, 4.0), (2.0, 9.0)] {
            trajectory.push(seconds, Pose2::new(x, 0.0, 0.0));
        }
        let x = |seconds| trajectory.at(seconds).map(|pose| pose.x());
        assert_eq!([x(0.0), x(1.0), x(1.5), x(3.0), x(9.0)], [0.0, 0.0, 1.0, 4.0, 4.0].map(Some));
    }
}
