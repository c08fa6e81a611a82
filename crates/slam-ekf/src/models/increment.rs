use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};

/// Odometry increments: the control is the motion in the robot frame since the last one, $`x' = x ∘ u`$.
///
/// The noise is a variance per m and per rad travelled: the result does not depend on the sampling of the log, and the covariance
/// of a robot at rest does not grow.
///
/// The defaults correspond to `σ = 0.02 m, 0.005 rad` over a step of 0.25 m.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct OdometryMotion {
    /// Variance along and across the motion per m, m²/m.
    pub translation_variance_per_meter: f64,
    /// Heading variance per m, rad²/m.
    pub heading_variance_per_meter: f64,
    /// Heading variance per radian turned, rad²/rad.
    pub heading_variance_per_radian: f64,
    /// Variance along and across the motion of every increment that is not zero, m²; for encoders with coarse ticks.
    pub translation_variance_per_step: f64,
    /// Heading variance of every increment that is not zero, rad².
    pub heading_variance_per_step: f64,
}

impl Default for OdometryMotion {
    fn default() -> Self {
        Self {
            translation_variance_per_meter: 0.02 * 0.02 / 0.25,
            heading_variance_per_meter: 0.005 * 0.005 / 0.25,
            heading_variance_per_radian: 2e-5,
            translation_variance_per_step: 0.0,
            heading_variance_per_step: 0.0,
        }
    }
}

impl MotionModel for OdometryMotion {
    type State = Pose2<f64>;
    type Control = Pose2<f64>;

    fn propagate(&self, pose: &Pose2<f64>, increment: &Pose2<f64>) -> Pose2<f64> {
        pose.compose(increment)
    }

    /// $`\begin{pmatrix} R(u_θ)^T & R(u_θ)^T (-u_y, u_x)^T \\ 0 & 1 \end{pmatrix} = \mathrm{Ad}_{u^{-1}}`$: in body coordinates it depends on
    /// the increment alone.
    fn jacobian(&self, _: &Pose2<f64>, increment: &Pose2<f64>) -> Matrix3<f64> {
        increment.inverse().adjoint()
    }

    fn noise(&self, _: &Pose2<f64>, increment: &Pose2<f64>) -> Matrix3<f64> {
        let (distance, turn) = (increment.translation.norm(), increment.heading().abs());
        if distance == 0.0 && turn == 0.0 {
            return Matrix3::zeros();
        }
        let translation = self.translation_variance_per_meter * distance + self.translation_variance_per_step;
        let heading = self.heading_variance_per_meter * distance
            + self.heading_variance_per_radian * turn
            + self.heading_variance_per_step;
        Matrix3::from_diagonal(&Vector3::new(translation, translation, heading))
    }
}
