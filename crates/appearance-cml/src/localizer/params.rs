use wayfix_integrity::RelocalizationParams;

use crate::{
    AppearanceMapError, AppearanceMapParams, MixtureFusionParams, MixtureReductionParams, OdometryNoise,
    check,
};

/// Whether the map changes while the robot drives.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceLocalizer, AppearanceMapError, LinearSearch};
/// # use wayfix_appearance_cml::{LocalizerParams, MapLearning, PanoramaDescriptor, StartPosePrior};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.02, 0.02, 0.01))?;
/// let learned = |map_learning| -> Result<usize, AppearanceMapError> {
///     let params = LocalizerParams { map_learning, ..Default::default() };
///     let mut robot = AppearanceLocalizer::<_, LinearSearch<_>>::new(params, StartPosePrior::Known(start.clone()))?;
///     for step in 0..40 {
///         robot.update(PanoramaDescriptor::from_parts(0.01, 1, vec![3, 3 * step, 0])?)?;
///         robot.predict(&Pose2::new(0.25, 0.0, 0.0))?;
///     }
///     Ok(robot.map().len())
/// };
/// assert!(learned(MapLearning::Adapting)? > 10 && learned(MapLearning::Static)? == 0);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MapLearning {
    /// The map stays as it is.
    Static,
    /// The map learns and forgets ([`ForgettingMode`](crate::ForgettingMode)).
    #[default]
    Adapting,
}

/// How matching places become hypotheses of the pose.
///
/// ```
/// use wayfix_appearance_cml::{LocalizerParams, PoseHypothesisRule};
/// assert_eq!(LocalizerParams::default().pose_hypothesis_rule, PoseHypothesisRule::Interpolation);
/// assert_eq!(LocalizerParams::as_published().pose_hypothesis_rule, PoseHypothesisRule::Superposition);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum PoseHypothesisRule {
    /// The weighted sum of all matching places of the map. [Gross et al. 2005, Sec. 2.2]
    Superposition,
    /// One hypothesis for each group of neighbours, interpolated between them ([`interpolate`](crate::interpolate)).
    #[default]
    Interpolation,
}

/// Parameters of the localizer.
///
/// ```
/// use wayfix_appearance_cml::LocalizerParams;
/// assert!(LocalizerParams::as_published().relocalization.is_off());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LocalizerParams {
    /// Noise of the odometry.
    pub odometry: OdometryNoise,
    /// Default [`PoseHypothesisRule::Interpolation`].
    pub pose_hypothesis_rule: PoseHypothesisRule,
    /// How odometry, view and other sources are fused.
    pub fusion: MixtureFusionParams,
    /// How the mixture is kept small.
    pub mixture_reduction: MixtureReductionParams,
    /// Minimum weight of the heaviest component of a unimodal belief. Default 0.8: four to one against all other poses.
    pub unimodal_min_weight: f64,
    /// Rates and distances of the test for a kidnapping; without false alarms there is no test.
    pub relocalization: RelocalizationParams,
    /// Default [`MapLearning::Adapting`].
    pub map_learning: MapLearning,
    /// How the map learns.
    pub map: AppearanceMapParams,
    /// Whether views that differ from both neighbours along the path are not learned: a person passes by. Default true.
    pub skip_outlier_views_in_mapping: bool,
}

impl Default for LocalizerParams {
    fn default() -> Self {
        Self {
            odometry: OdometryNoise::default(),
            pose_hypothesis_rule: PoseHypothesisRule::default(),
            fusion: MixtureFusionParams::default(),
            mixture_reduction: MixtureReductionParams::default(),
            unimodal_min_weight: 0.8,
            relocalization: RelocalizationParams::default(),
            map_learning: MapLearning::default(),
            map: AppearanceMapParams::default(),
            skip_outlier_views_in_mapping: true,
        }
    }
}

impl LocalizerParams {
    /// The method as published: superposition, covariance intersection by Eqs. 3-8, no test for a kidnapping, every view learned. Mixtures are simplified as by
    /// default; the paper merges components "similar" to Eq. 12.
    pub fn as_published() -> Self {
        Self {
            pose_hypothesis_rule: PoseHypothesisRule::Superposition,
            fusion: MixtureFusionParams::as_published(),
            relocalization: RelocalizationParams::off(),
            map: AppearanceMapParams::as_published(),
            skip_outlier_views_in_mapping: false,
            ..Self::default()
        }
    }

    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        self.odometry.validate()?;
        self.fusion.validate()?;
        self.mixture_reduction.validate()?;
        check::share("unimodal_min_weight", self.unimodal_min_weight)?;
        self.relocalization.validate()?;
        self.map.validate()
    }
}
