use super::{LandmarkConfirmationParams, LandmarkMergingParams, LinearizationPoint};
use crate::SlamError;

/// Parameters of the filter, the same for every kind of landmark.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct SlamParams {
    /// Treatment of observations outside the gate.
    pub outlier_rule: OutlierRule,
    /// Probability with which a correct observation passes the gate: a chi-squared quantile with the measurement's degrees of freedom.
    /// At 0.9999 (18.4 for range and bearing) one correct observation in ten thousand fails.
    pub gate_probability: f64,
    /// Degrees of freedom of the Student-t distribution assumed for observations outside the gate; the tails of 4 are heavy enough for gross
    /// outliers.
    pub student_t_degrees_of_freedom: f64,
    /// Joint or sequential correction with the observations of one scan.
    pub update_order: UpdateOrder,
    /// Storage of the joint covariance: full or compressed.
    pub covariance_update: CovarianceUpdate,
    /// Linearization points, which decide whether the filter stays consistent on long loops.
    pub linearization_point: LinearizationPoint,
    /// Number of the first landmarks that become anchors when they are confirmed, see [`EkfSlam::fix`](crate::EkfSlam::fix); anchors that are
    /// given count. The paper: 1.
    pub anchor_first: usize,
    /// A landmark with more revisions leaves the state, see [`EkfSlam::retire`](crate::EkfSlam::retire); never, if not given. The
    /// paper: 50.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub retire_after: Option<usize>,
    /// Conditions for a landmark to be confirmed.
    pub confirmation: LandmarkConfirmationParams,
    /// When two landmarks of the map are merged; never, if not given.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub merging: Option<LandmarkMergingParams>,
}

/// Treatment of observations outside the gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum OutlierRule {
    /// Their weight decreases with their NIS, but none is rejected: the filter recovers after it was overconfident.
    #[default]
    Downweight,
    /// They are rejected. An overconfident filter can then reject all later observations.
    Reject,
}

/// Joint or sequential correction with the observations of one scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum UpdateOrder {
    /// All at once, linearized at the predicted state: the result does not depend on their order, and large maps are fast.
    #[default]
    Joint,
    /// One after the other, each linearized at the state that the one before it left.
    Sequential,
}

/// Storage of the joint covariance of robot and map. The estimates are the same.
///
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_slam_ekf::*;
///
/// let scan = [Observation { label: Some(LandmarkId(7)), measurement: RangeBearing::new(2.0, 0.1) }];
/// let robot = |covariance_update| {
///     let params = SlamParams { covariance_update, ..SlamParams::default() };
///     let mut slam = EkfSlam::new(RangeBearingSensor::default(), params, Pose2::new(0.0, 0.0, 0.0))?;
///     slam.update(&scan, &mut KnownIdAssociation)?;
///     slam.predict(&OdometryMotion::default(), &Pose2::new(0.1, 0.0, 0.0))?;
///     slam.update(&scan, &mut KnownIdAssociation)?;
///     Ok::<_, SlamError>(slam.robot().x())
/// };
/// assert!((robot(CovarianceUpdate::Full)? - robot(CovarianceUpdate::Compressed)?).abs() < 1e-12);
/// # Ok::<(), SlamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum CovarianceUpdate {
    /// One matrix, up to date: a correction costs the square of the number of landmarks in the map.
    #[default]
    Full,
    /// The area around the robot up to date, with deferred updates of the rest: a correction costs the square of the number of landmarks in the
    /// area. Landmarks whose `retract` is an addition, such as points, get the same means up to rounding.
    /// [Guivant & Nebot 2001]
    Compressed,
}

impl UpdateOrder {
    pub(super) fn batch_size(self, n_observations: usize) -> usize {
        match self {
            Self::Joint => n_observations.max(1),
            Self::Sequential => 1,
        }
    }
}

impl Default for SlamParams {
    fn default() -> Self {
        Self {
            outlier_rule: OutlierRule::default(),
            gate_probability: 0.9999,
            student_t_degrees_of_freedom: 4.0,
            update_order: UpdateOrder::Joint,
            covariance_update: CovarianceUpdate::default(),
            linearization_point: LinearizationPoint::default(),
            anchor_first: 0,
            retire_after: None,
            confirmation: LandmarkConfirmationParams::default(),
            merging: None,
        }
    }
}

impl SlamParams {
    pub(super) fn validated(self) -> Result<Self, SlamError> {
        let degrees = self.student_t_degrees_of_freedom;
        if !(degrees > 0.0 && degrees.is_finite()) {
            let range = "positive";
            return Err(SlamError::Parameter { name: "student_t_degrees_of_freedom", value: degrees, range });
        }
        let tentative_restart_nis = self.confirmation.tentative_restart_nis;
        if tentative_restart_nis.is_nan() || tentative_restart_nis <= 0.0 {
            let range = "positive";
            return Err(SlamError::Parameter {
                name: "tentative_restart_nis",
                value: tentative_restart_nis,
                range,
            });
        }
        let share = self.confirmation.min_detection_rate;
        if !(0.0..=1.0).contains(&share) {
            return Err(SlamError::Parameter {
                name: "min_detection_rate",
                value: share,
                range: "from 0 to 1",
            });
        }
        self.merging.map(LandmarkMergingParams::validated).transpose()?;
        Ok(self)
    }

    /// Factor on the noise of an observation whose NIS is beyond the threshold.
    ///
    /// The Student-t log-likelihood has the slope of a Gaussian whose covariance is larger by $`(ν + d^2) / (ν + m)`$
    /// [Lange, Little & Taylor 1989, section 3]. Here it starts at the threshold in place of $`m`$: observations inside the gate keep
    /// the weight of the Kalman filter, and the weight is continuous.
    pub(super) fn noise_scale(&self, nis: f64, threshold: f64) -> f64 {
        let degrees = self.student_t_degrees_of_freedom;
        ((degrees + nis) / (degrees + threshold)).max(1.0)
    }
}
