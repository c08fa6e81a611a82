use nalgebra::Matrix3;
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};
use wayfix_gaussian_core::{Gaussian, symmetrize};

use crate::AppearanceMapError;

/// Odometry between two views: the accumulated increment and the covariance of its error, in the body frame at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    pub(crate) increment: Pose2<f64>,
    /// m² and rad².
    pub(crate) covariance: Matrix3<f64>,
    /// Whether a part of it was not measured.
    pub(crate) has_gap: bool,
}

impl Motion {
    pub(crate) fn none() -> Self {
        Self { increment: Pose2::identity(), covariance: Matrix3::zeros(), has_gap: false }
    }

    /// One odometry increment of a robot at `from`.
    pub(crate) fn of_increment<M>(model: &M, from: &Pose2<f64>, increment: &Pose2<f64>) -> Self
    where
        M: MotionModel<State = Pose2<f64>, Control = Pose2<f64>>,
    {
        let to = model.propagate(from, increment);
        Self {
            increment: from.inverse().compose(&to),
            covariance: model.noise(from, increment),
            has_gap: false,
        }
    }

    /// This motion followed by `next`.
    pub(crate) fn then(&self, next: &Self) -> Result<Self, AppearanceMapError> {
        let increment = self.increment.compose(&next.increment);
        let transition = next.increment.inverse().adjoint();
        let mut covariance = transition * self.covariance * transition.transpose() + next.covariance;
        symmetrize(&mut covariance);
        let is_finite = increment.is_finite() && covariance.iter().all(|entry| entry.is_finite());
        if !is_finite {
            return Err(AppearanceMapError::NotFinite { what: "odometry increment" });
        }
        Ok(Self { increment, covariance, has_gap: self.has_gap || next.has_gap })
    }

    /// Straight distance, m.
    pub(crate) fn distance(&self) -> f64 {
        self.increment.translation.norm()
    }

    /// The belief at the end of the motion, from a belief at its start. [Gross et al. 2005, Eq. 1]
    pub(crate) fn applied(&self, belief: &Gaussian<Pose2<f64>>) -> Option<Gaussian<Pose2<f64>>> {
        let start = Self { increment: *belief.mean(), covariance: *belief.covariance(), has_gap: false };
        let end = start.then(self).ok()?;
        Some(Gaussian::from_parts_unchecked(end.increment, end.covariance))
    }

    /// The belief at the start of the motion, from a belief at its end.
    pub(crate) fn undone(&self, belief: &Gaussian<Pose2<f64>>) -> Gaussian<Pose2<f64>> {
        let back = self.increment.inverse();
        let transition = self.increment.adjoint();
        let mut covariance = transition * (belief.covariance() + self.covariance) * transition.transpose();
        symmetrize(&mut covariance);
        Gaussian::from_parts_unchecked(belief.mean().compose(&back), covariance)
    }
}

/// The motion model of a recorded motion: the control carries its own covariance.
pub(crate) struct RecordedMotion;

impl MotionModel for RecordedMotion {
    type State = Pose2<f64>;
    type Control = Motion;

    fn propagate(&self, pose: &Pose2<f64>, motion: &Motion) -> Pose2<f64> {
        pose.compose(&motion.increment)
    }

    fn jacobian(&self, _: &Pose2<f64>, motion: &Motion) -> Matrix3<f64> {
        motion.increment.inverse().adjoint()
    }

    fn noise(&self, _: &Pose2<f64>, motion: &Motion) -> Matrix3<f64> {
        motion.covariance
    }
}
