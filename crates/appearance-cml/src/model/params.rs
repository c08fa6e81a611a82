use crate::{AppearanceMapError, check};

/// Whether and how the map forgets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ForgettingMode {
    /// References that are seen somewhere else lose weight. [Gross et al. 2005, Eq. 17]
    Passive,
    /// As well, references of this place that are not seen lose weight. [Gross et al. 2005, Eqs. 18-19]
    #[default]
    Active,
}

/// Measurement from which a matched reference view learns its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum PlaceUpdateRule {
    /// The pose of the robot, into every reference of the map that looks like the view; a reference is inserted when none does.
    /// [Gross et al. 2005, Sec. 2.3 as printed]
    Pose,
    /// The pose of the robot less what the references of this place say it is: their errors are corrected and their distances from one
    /// another stay. Only references of this place are touched, and a view that looks like one elsewhere is a reference of its own.
    #[default]
    Residual,
}

/// Whose uncertainty slows active forgetting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ForgettingUncertainty {
    /// That of the robot, $`σ_x + σ_y`$. [Gross et al. 2005, Eq. 19 as printed] In a map that the robot builds on its way it is never less than what the map
    /// itself errs by, and slows forgetting for good.
    Pose,
    /// That of the robot against the place: $`\sqrt{2 \max(σ_x^2 + σ_y^2 - σ_{x,i}^2 - σ_{y,i}^2, 0)}`$, which is the printed sum where
    /// both axes are alike and the place is known. What the place errs by is common to both.
    #[default]
    AgainstPlace,
}

/// How active forgetting fades references. [Gross et al. 2005, Eq. 19]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ForgettingParams {
    /// $`β_{for}`$: the share of weight that a reference at the very place loses. Default 0.6.
    pub rate: f64,
    /// $`d^{for}`$: how far from the robot references are forgotten, m; `None` takes two thirds of the distance at which views still match, from the
    /// [`ViewDistanceScale`](super::ViewDistanceScale). Default `None`.
    pub radius: Option<f64>,
    /// $`d^{gain}`$: the uncertainty up to which forgetting goes at full rate, m; a less certain pose forgets more slowly.
    /// `None` takes two steps between views. Default `None`.
    pub full_rate_sigma: Option<f64>,
    /// Default [`ForgettingUncertainty::AgainstPlace`].
    pub uncertainty_measure: ForgettingUncertainty,
}

impl Default for ForgettingParams {
    fn default() -> Self {
        Self {
            rate: 0.6,
            radius: None,
            full_rate_sigma: None,
            uncertainty_measure: ForgettingUncertainty::default(),
        }
    }
}

/// How the appearance map learns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct AppearanceMapParams {
    /// $`E^{max}`$, in units of the descriptor; `None` finds it from the data. Default `None`.
    pub match_limit: Option<f64>,
    /// Where between noise (0) and far places (1) the limit found from the data lies. Default 0.4.
    pub match_limit_fraction: f64,
    /// Distance to the nearest reference of the place from which on a view becomes a reference, as a multiple of the distance of
    /// successive views; never above $`E^{max}`$. Default 1. (As printed: $`E^{max}`$ itself, with [`PlaceUpdateRule::Pose`].)
    pub insertion_distance_factor: f64,
    /// $`β`$: learning rate of the weights. Default 0.3.
    pub learning_rate: f64,
    /// $`δ`$: squared Mahalanobis distance below which two places of a reference are one. Default 7.8.
    pub merge_distance: f64,
    /// $`d^{max}`$: squared Mahalanobis distance up to which a place agrees with the pose. Default 16.3.
    pub place_gate: f64,
    /// Default [`PlaceUpdateRule::Residual`].
    pub place_update: PlaceUpdateRule,
    /// Default [`ForgettingMode::Active`].
    pub forgetting_mode: ForgettingMode,
    /// How active forgetting works.
    pub active_forgetting: ForgettingParams,
    /// Weight below which a place is removed. Default 0.05: what was seen once goes after five misses or so.
    pub min_weight: f64,
    /// Observations after which a place no longer gets more rigid. Default 20.
    pub max_observation_count: f64,
    /// Most references; beyond, the least important one near the robot goes. Default 1 000 000.
    pub max_references: usize,
}

impl Default for AppearanceMapParams {
    fn default() -> Self {
        Self {
            match_limit: None,
            match_limit_fraction: 0.4,
            insertion_distance_factor: 1.0,
            learning_rate: 0.3,
            merge_distance: 7.8,
            place_gate: 16.3,
            place_update: PlaceUpdateRule::default(),
            forgetting_mode: ForgettingMode::default(),
            active_forgetting: ForgettingParams::default(),
            min_weight: 0.05,
            max_observation_count: 20.0,
            max_references: 1_000_000,
        }
    }
}

impl AppearanceMapParams {
    /// The learning rules as printed.
    pub fn as_published() -> Self {
        Self {
            place_update: PlaceUpdateRule::Pose,
            max_observation_count: f64::MAX,
            active_forgetting: ForgettingParams {
                uncertainty_measure: ForgettingUncertainty::Pose,
                ..ForgettingParams::default()
            },
            ..Self::default()
        }
    }

    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::positive("match limit", self.match_limit.unwrap_or(1.0))?;
        check::share("share of the match limit", self.match_limit_fraction)?;
        check::positive("insertion_distance_factor", self.insertion_distance_factor)?;
        check::share("learning rate", self.learning_rate)?;
        check::not_negative("merge distance of places", self.merge_distance)?;
        check::positive("gate of places", self.place_gate)?;
        check::share("rate of forgetting", self.active_forgetting.rate)?;
        check::positive("radius of forgetting (m)", self.active_forgetting.radius.unwrap_or(1.0))?;
        check::positive(
            "full_rate_sigma of forgetting (m)",
            self.active_forgetting.full_rate_sigma.unwrap_or(1.0),
        )?;
        check::share("least weight of a place", self.min_weight)?;
        check::positive("greatest count of a place", self.max_observation_count)?;
        check::count("references to keep", self.max_references)
    }
}
