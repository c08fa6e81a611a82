use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;

use crate::{AppearanceMapError, check};

/// How odometry errs: variances that grow with the way and with the turn, so that cutting a motion in pieces changes nothing.
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
    /// σ along the way after one metre, m. Default 0.025.
    pub forward_sigma_per_meter: f64,
    /// σ across the way after one metre, m. Default 0.02.
    pub sideways_sigma_per_meter: f64,
    /// σ of the heading after one metre, rad. Default 0.008.
    pub heading_sigma_per_meter: f64,
    /// σ of the heading after turning by one radian, rad. Default 0.02.
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

/// σ below which no motion is believed, m and rad: a robot that stands still keeps a covariance that can be factored.
const FLOOR: f64 = 1e-6;

impl OdometryNoise {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::not_negative("forward noise of the odometry (m)", self.forward_sigma_per_meter)?;
        check::not_negative("sideways noise of the odometry (m)", self.sideways_sigma_per_meter)?;
        check::not_negative("heading noise of the odometry a metre (rad)", self.heading_sigma_per_meter)?;
        check::not_negative("heading noise of the odometry a radian (rad)", self.heading_sigma_per_radian)
    }

    /// Covariance of the error of one increment, in the body frame at its end.
    pub fn covariance(&self, increment: &Pose2<f64>) -> Matrix3<f64> {
        let distance = increment.translation.norm();
        let turn = increment.heading().abs();
        let heading =
            self.heading_sigma_per_meter.powi(2) * distance + self.heading_sigma_per_radian.powi(2) * turn;
        let floor = FLOOR * FLOOR;
        Matrix3::from_diagonal(&Vector3::new(
            self.forward_sigma_per_meter.powi(2) * distance + floor,
            self.sideways_sigma_per_meter.powi(2) * distance + floor,
            heading + floor,
        ))
    }
}
