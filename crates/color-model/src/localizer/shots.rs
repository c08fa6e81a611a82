use std::collections::VecDeque;

use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};

use super::{OdometryNoise, OdometryStep};
use crate::YuvImage;

/// A frame, and how the robot came to where it was taken.
#[derive(Clone, Debug)]
pub(crate) struct Shot {
    pub(crate) image: YuvImage,
    pub(crate) mount: Pose3<f64>,
    pub(crate) walked: Walked,
}

/// Odometry between two frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walked {
    pub(crate) increment: Pose2<f64>,
    pub(crate) seconds: f64,
    /// Variances of translation, each axis, and of rotation.
    variances: (f64, f64),
}

impl Default for Walked {
    fn default() -> Self {
        Self { increment: Pose2::identity(), seconds: 0.0, variances: (0.0, 0.0) }
    }
}

impl Walked {
    pub(crate) fn add(&mut self, step: &OdometryStep, noise: &OdometryNoise) {
        let (translation, rotation) = noise.sigmas(step);
        self.increment = self.increment.compose(&step.increment.unwrap_or_else(Pose2::identity));
        self.seconds += step.seconds;
        self.variances.0 += translation * translation;
        self.variances.1 += rotation * rotation;
    }

    fn and(&self, next: &Self) -> Self {
        Self {
            increment: self.increment.compose(&next.increment),
            seconds: self.seconds + next.seconds,
            variances: (self.variances.0 + next.variances.0, self.variances.1 + next.variances.1),
        }
    }

    /// Standard deviations of translation, each axis, and of rotation.
    pub(crate) fn sigmas(&self) -> (f64, f64) {
        (self.variances.0.sqrt(), self.variances.1.sqrt())
    }
}

/// The last frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shots(VecDeque<Shot>);

impl Shots {
    /// Adds the newest; keeps the last `capacity`.
    pub(crate) fn push(&mut self, shot: Shot, capacity: usize) {
        self.0.push_back(shot);
        while self.0.len() > capacity.max(1) {
            self.0.pop_front();
        }
    }

    /// The last `n` of them.
    pub(crate) fn last(&self, n: usize) -> Self {
        Self(self.0.iter().skip(self.0.len().saturating_sub(n)).cloned().collect())
    }

    /// At most `most` of them, evenly spread, the newest among them, with the odometry between.
    pub(crate) fn spread(&self, most: usize) -> Vec<Shot> {
        let stride = self.0.len().div_ceil(most.max(1)).max(1);
        let mut chosen: Vec<Shot> = Vec::new();
        let mut walked = Walked::default();
        for (at, shot) in self.0.iter().enumerate() {
            walked = walked.and(&shot.walked);
            if (self.0.len() - 1 - at).is_multiple_of(stride) {
                chosen.push(Shot { walked, ..shot.clone() });
                walked = Walked::default();
            }
        }
        chosen
    }
}
