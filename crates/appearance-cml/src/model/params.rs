use crate::{AppearanceMapError, check};

/// Whether and how the map forgets.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceMap, AppearanceMapError, AppearanceMapParams};
/// # use wayfix_appearance_cml::{ForgettingMode, PanoramaDescriptor, ReferenceId, ViewDifferenceSample};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// # let pose = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let weight_of_first = |forgetting_mode| -> Result<Option<f64>, AppearanceMapError> {
///     let params = AppearanceMapParams { forgetting_mode, ..Default::default() };
///     let mut map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// #     map.scale_mut().add_near(ViewDifferenceSample { lag: 0.25, distance: 0.1 });
///     map.learn(view(20)?, &pose, &params, 16.3)?;
///     map.learn(view(90)?, &pose, &params, 16.3)?; // the place looks different now
///     Ok(map.reference(ReferenceId(0)).map(|reference| reference.importance()))
/// };
/// assert_eq!(weight_of_first(ForgettingMode::Passive)?, Some(0.3));
/// assert!(weight_of_first(ForgettingMode::Active)?.is_some_and(|weight| (weight - 0.3 * (1.0 - 0.6)).abs() < 1e-12));
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ForgettingMode {
    /// References that match at another place lose weight. [Gross et al. 2005, Eq. 17]
    Passive,
    /// References of this place that do not match lose weight too. [Gross et al. 2005, Eqs. 18–19]
    #[default]
    Active,
}

/// What a view changes in the references that match it.
///
/// ```
/// use wayfix_appearance_cml::{AppearanceMapParams, PlaceUpdateRule};
/// assert_eq!(AppearanceMapParams::default().place_update, PlaceUpdateRule::Residual);
/// assert_eq!(AppearanceMapParams::as_published().place_update, PlaceUpdateRule::Pose);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum PlaceUpdateRule {
    /// Adds the pose of the robot to every matching reference of the map; a view that matches none becomes a reference.
    /// [Gross et al. 2005, Sec. 2.3]
    Pose,
    /// Adds the difference between the pose of the robot and the pose that the references give: their errors are corrected, and their
    /// distances from one another stay. It changes references of this place only, and a view that matches elsewhere becomes a reference.
    #[default]
    Residual,
}

/// The uncertainty that slows active forgetting down.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceMap, AppearanceMapError, AppearanceMapParams};
/// # use wayfix_appearance_cml::{ForgettingUncertainty, PanoramaDescriptor, ReferenceId, ViewDifferenceSample};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let view = |re: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, 0]);
/// # let pose = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let weight_of_first = |forgetting_uncertainty_kind| -> Result<Option<f64>, AppearanceMapError> {
///     let params = AppearanceMapParams { forgetting_uncertainty_kind, ..Default::default() };
///     let mut map: AppearanceMap<PanoramaDescriptor> = AppearanceMap::default();
/// #     map.scale_mut().add_near(ViewDifferenceSample { lag: 0.25, distance: 0.1 });
///     map.learn(view(20)?, &pose, &params, 16.3)?;
///     map.learn(view(90)?, &pose, &params, 16.3)?; // the place looks different now
///     Ok(map.reference(ReferenceId(0)).map(|reference| reference.importance()))
/// };
/// assert!(weight_of_first(ForgettingUncertainty::AgainstPlace)?.is_some_and(|weight| (weight - 0.3 * (1.0 - 0.6)).abs() < 1e-12));
/// assert_eq!(weight_of_first(ForgettingUncertainty::Pose)?, None); // 0.6 · 0.5 m / 0.2 m is above 1: forgotten at once
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ForgettingUncertainty {
    /// $`σ_x + σ_y`$ of the robot along the axes of the map, without an upper bound of the rate. [Gross et al. 2005, Eq. 19]
    Pose,
    /// That of the robot against the place: $`\sqrt{2 \max(σ_x^2 + σ_y^2 - σ_{x,i}^2 - σ_{y,i}^2, 0)}`$, because robot and place have the
    /// error of the place in common. It equals the published sum for isotropic σ and a known place. The rate is at most $`β_{for}`$.
    #[default]
    AgainstPlace,
}

/// How the appearance map learns.
///
/// ```
/// use wayfix_appearance_cml::AppearanceMapParams;
/// assert!(AppearanceMapParams::default().validate().is_ok());
/// assert!(AppearanceMapParams { weight_learning_rate: 1.5, ..AppearanceMapParams::default() }.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct AppearanceMapParams {
    /// $`E^{max}`$ as a share of the squared difference of far places, between noise (0) and those (1). Default 0.4: a matching view
    /// is nearer to noise than to a far place.
    pub max_match_difference_share: f64,
    /// $`β`$: learning rate of the weights (Eqs. 16-17). Default 0.3: a place that was seen twice has half of the full weight.
    pub weight_learning_rate: f64,
    /// Default [`PlaceUpdateRule::Residual`].
    pub place_update: PlaceUpdateRule,
    /// Default [`ForgettingMode::Active`].
    pub forgetting_mode: ForgettingMode,
    /// $`β_{for}`$: rate of active forgetting (Eq. 19). Default 0.6, twice $`β`$: a reference goes faster than it comes.
    pub forgetting_rate: f64,
    /// Default [`ForgettingUncertainty::AgainstPlace`].
    pub forgetting_uncertainty_kind: ForgettingUncertainty,
    /// Weight below which a place is removed. Default 0.05: a place that was seen once is removed after two mismatches at the very place.
    pub min_weight: f64,
    /// Count from which on a place does not become more rigid (Eq. 13). Default 20: the mean of 20 views has a quarter of
    /// the error of one.
    pub max_effective_observation_count: f64,
    /// Maximum number of references; the least important one is removed first. Default 1 000 000: one gigabyte.
    pub max_references: usize,
}

impl Default for AppearanceMapParams {
    fn default() -> Self {
        Self {
            max_match_difference_share: 0.4,
            weight_learning_rate: 0.3,
            place_update: PlaceUpdateRule::default(),
            forgetting_mode: ForgettingMode::default(),
            forgetting_rate: 0.6,
            forgetting_uncertainty_kind: ForgettingUncertainty::default(),
            min_weight: 0.05,
            max_effective_observation_count: 20.0,
            max_references: 1_000_000,
        }
    }
}

impl AppearanceMapParams {
    /// The learning rules as published.
    pub fn as_published() -> Self {
        Self {
            place_update: PlaceUpdateRule::Pose,
            max_effective_observation_count: f64::MAX,
            forgetting_uncertainty_kind: ForgettingUncertainty::Pose,
            ..Self::default()
        }
    }

    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::share("share of the match limit", self.max_match_difference_share)?;
        check::share("learning rate", self.weight_learning_rate)?;
        check::share("rate of forgetting", self.forgetting_rate)?;
        check::share("min_weight of a place", self.min_weight)?;
        check::positive("max_effective_observation_count of a place", self.max_effective_observation_count)?;
        check::count("max_references", self.max_references)
    }
}
