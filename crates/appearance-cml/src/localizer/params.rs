use super::RelocationParams;
use crate::{
    AppearanceMapError, AppearanceMapParams, FusionParams, MixtureReductionParams, OdometryNoise,
    UnimodalParams, check,
};

/// What happens to the map while the robot drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Learning {
    /// Nothing: the map stays as it is.
    Static,
    /// It is learned and forgotten; [`ForgettingMode`](crate::ForgettingMode) says how.
    #[default]
    Adapting,
}

/// How the places that look like the view become hypotheses of the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Observation {
    /// All of them, weighted, as printed.
    Superposition,
    /// One for each group of neighbours, interpolated between them.
    #[default]
    Interpolation,
}

/// Everything that can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LocalizerParams {
    /// How odometry errs.
    pub odometry: OdometryNoise,
    /// How the places that look like the view are read. Default [`Observation::Interpolation`].
    pub observation: Observation,
    /// References of the whole map that a view is compared with at most, beside those where the robot is thought to be. Default 40.
    pub most_matches: usize,
    /// How odometry, view and other sources are fused.
    pub fusion: FusionParams,
    /// How the mixture is kept small.
    pub simplify: MixtureReductionParams,
    /// When the robot doubts where it is, and how it finds itself again.
    pub relocation: RelocationParams,
    /// When the mixture counts as one place.
    pub unimodal: UnimodalParams,
    /// Default [`Learning::Adapting`].
    pub learning: Learning,
    /// How the map learns.
    pub map: AppearanceMapParams,
    /// Views by which learning lags behind, so that a pose is not confirmed by what it has just taught. Default 10.
    pub delay: usize,
    /// Views by which learning lags behind at most where the robot, in a part of the map that was surveyed, has become less sure of where it is: the next place
    /// that it recognizes corrects them first. 0 to wait for no such place, as printed. Default 60.
    pub patience: usize,
    /// Views that wait at most for the state to become one place, and while a belief that was ousted goes along; older ones are not learned. Default 400: twice
    /// [`RelocationParams::ousted_way`] at four views a metre.
    pub longest_wait: usize,
    /// Views of the way behind the robot over which a correction is spread where surveyed references lie around it, and with it the references made there; 0
    /// leaves them where they are, as printed. Default 2000: half a kilometre.
    pub memory: usize,
    /// Distance to its neighbours along the way, as a multiple of the distance of successive views, beyond which a view is taken for an
    /// outlier (somebody passes) and not learned; `None` learns every view. Default 1.6.
    pub corroboration: Option<f64>,
}

impl Default for LocalizerParams {
    fn default() -> Self {
        Self {
            odometry: OdometryNoise::default(),
            observation: Observation::default(),
            most_matches: 40,
            fusion: FusionParams::default(),
            simplify: MixtureReductionParams::default(),
            relocation: RelocationParams::default(),
            unimodal: UnimodalParams::default(),
            learning: Learning::default(),
            map: AppearanceMapParams::default(),
            delay: 10,
            patience: 60,
            longest_wait: 400,
            memory: 2000,
            corroboration: Some(1.6),
        }
    }
}

impl LocalizerParams {
    /// The method as printed: superposition, covariance intersection by Eqs. 3-8, every view learned as it is.
    pub fn printed() -> Self {
        Self {
            observation: Observation::Superposition,
            fusion: FusionParams::as_published(),
            simplify: MixtureReductionParams { min_weight: 0.005, ..MixtureReductionParams::default() },
            map: AppearanceMapParams::as_published(),
            relocation: RelocationParams { doubt: 1.0, ..RelocationParams::default() },
            corroboration: None,
            patience: 0,
            memory: 0,
            ..Self::default()
        }
    }

    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        self.odometry.validate()?;
        check::count("matches", self.most_matches)?;
        self.fusion.validate()?;
        self.simplify.validate()?;
        self.relocation.validate()?;
        self.unimodal.validate()?;
        self.map.validate()?;
        check::count("longest wait (views)", self.longest_wait)?;
        check::positive("corroboration", self.corroboration.unwrap_or(1.0))
    }
}
