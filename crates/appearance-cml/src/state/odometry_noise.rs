use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};

use crate::{AppearanceMapError, check};

/// The default motion model: odometry whose error variances grow with distance and turn. Splitting a motion changes nothing.
///
/// ```
/// use wayfix_appearance_cml::OdometryNoise;
/// use wayfix_estimation_traits::Pose2;
/// let noise = OdometryNoise::default();
/// let metre = noise.covariance(&Pose2::new(1.0, 0.0, 0.0));
/// let quarter = noise.covariance(&Pose2::new(0.25, 0.0, 0.0));
/// assert!((metre - quarter * 4.0).norm() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct OdometryNoise {
    /// σ along the motion after one metre, m. Default 0.025; the wheels of your robot decide.
    pub forward_sigma_per_meter: f64,
    /// σ across the motion after one metre, m. Default 0.02; the wheels of your robot decide.
    pub sideways_sigma_per_meter: f64,
    /// σ of the heading after one metre, rad. Default 0.008; the wheels of your robot decide.
    pub heading_sigma_per_meter: f64,
    /// σ of the heading after turning by one radian, rad. Default 0.02; the wheels of your robot decide.
    pub heading_sigma_per_radian: f64,
}

impl Default for OdometryNoise {
    fn default() -> Self {
        Self {
            forward_sigma_per_meter: 0.025,
            sideways_sigma_per_meter: 0.02,
            heading_sigma_per_meter: 0.008,
            heading_sigma_per_radian: 0.02,
        }
    }
}

impl OdometryNoise {
    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::not_negative("forward noise of the odometry (m)", self.forward_sigma_per_meter)?;
        check::not_negative("sideways noise of the odometry (m)", self.sideways_sigma_per_meter)?;
        check::not_negative("heading noise of the odometry a metre (rad)", self.heading_sigma_per_meter)?;
        check::not_negative("heading noise of the odometry a radian (rad)", self.heading_sigma_per_radian)
    }

    /// Covariance of the error of one increment, in the body frame at its end. Machine precision keeps it positive definite at rest.
    pub fn covariance(&self, increment: &Pose2<f64>) -> Matrix3<f64> {
        let (distance, turn) = (increment.translation.norm(), increment.heading().abs());
        let variances = Vector3::new(
            self.forward_sigma_per_meter.powi(2) * distance,
            self.sideways_sigma_per_meter.powi(2) * distance,
            self.heading_sigma_per_meter.powi(2) * distance + self.heading_sigma_per_radian.powi(2) * turn,
        );
        Matrix3::from_diagonal(&variances.add_scalar(f64::EPSILON))
    }
}

impl MotionModel for OdometryNoise {
    type State = Pose2<f64>;
    type Control = Pose2<f64>;

    /// $`x' = x ∘ u`$.
    fn propagate(&self, pose: &Pose2<f64>, increment: &Pose2<f64>) -> Pose2<f64> {
        pose.compose(increment)
    }

    /// $`∂(x ∘ u)/∂x = \mathrm{Ad}_{u^{-1}}`$ between body frames.
    fn jacobian(&self, _: &Pose2<f64>, increment: &Pose2<f64>) -> Matrix3<f64> {
        increment.inverse().adjoint()
    }

    fn noise(&self, _: &Pose2<f64>, increment: &Pose2<f64>) -> Matrix3<f64> {
        self.covariance(increment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wayfix_estimation_traits::laws;

    #[test]
    fn odometry_noise_obeys_the_laws_of_motion_models() {
        let controls = [Pose2::new(0.7, -0.3, 0.9), Pose2::new(0.0, 0.0, 0.0), Pose2::new(-0.2, 0.1, -2.0)];
        let cases = controls.each_ref().map(|control| (Pose2::new(4.0, 2.0, 3.0), control));
        laws::motion(&OdometryNoise::default(), &cases).expect("the laws hold");
    }
}
