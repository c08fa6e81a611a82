use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::SlamSmootherError;

/// A range to a beacon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Number of the pose it is measured from: 0 for the first.
    pub pose: usize,
    /// Identity of the beacon.
    pub beacon: u32,
    /// What the receiver shows, m.
    pub range: f64,
}

/// A run: motions from pose to pose, and ranges from the poses.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeOnlyInput {
    /// The first pose, in the frame of the map.
    pub start: Pose2<f64>,
    /// Motion k leads from pose k to pose k + 1, in the frame of pose k.
    pub motions: Vec<Pose2<f64>>,
    /// Ranges in any order.
    pub ranges: Vec<Range>,
}

impl RangeOnlyInput {
    /// Number of poses.
    pub fn n_poses(&self) -> usize {
        self.motions.len() + 1
    }

    /// The poses by odometry alone.
    pub fn dead_reckoning(&self) -> Vec<Pose2<f64>> {
        let mut poses = vec![self.start];
        extend(&mut poses, &self.motions);
        poses
    }

    pub(super) fn check(&self) -> Result<(), SlamSmootherError> {
        let not_finite = |pose: &Pose2<f64>| !pose.is_finite();
        if let Some(index) = std::iter::once(&self.start).chain(&self.motions).position(not_finite) {
            let (what, wanted) = ("motion", "finite");
            return Err(SlamSmootherError::OutOfRange { what, index, value: f64::NAN, wanted });
        }
        for (index, Range { pose, range, .. }) in self.ranges.iter().enumerate() {
            let n_poses = self.n_poses();
            if *pose >= n_poses {
                return Err(SlamSmootherError::UnknownPose { index, pose: *pose, n_poses });
            }
            if !(*range > 0.0 && range.is_finite()) {
                let (what, wanted) = ("range", "positive and finite");
                return Err(SlamSmootherError::OutOfRange { what, index, value: *range, wanted });
            }
        }
        Ok(())
    }
}

/// Appends what the motions lead to from the last pose.
pub(super) fn extend(poses: &mut Vec<Pose2<f64>>, motions: &[Pose2<f64>]) {
    for motion in motions {
        if let Some(last) = poses.last() {
            poses.push(last.compose(motion));
        }
    }
}
