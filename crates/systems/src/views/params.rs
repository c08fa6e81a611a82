use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_condensation::{
    AppearanceLearningParams, DominantGrayCriterion, NavigatorParams, ViewLocalizerParams,
};

/// Parameters of `wayfix run views`, independent of the scene.
///
/// ```
/// use wayfix_system_core::settings::from_toml;
/// use wayfix_systems::views::ViewsParams;
/// let params = from_toml::<ViewsParams>("[navigator]\nmax_steps = 40")?;
/// assert_eq!((params.navigator.max_steps, params.navigator.n_confirmations), (40, 3)); // the rest as it was
/// assert!(from_toml::<ViewsParams>("[navigator]\nmax_stesp = 40").is_err());
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViewsParams {
    /// Definition of the numbers of `hist6`.
    pub dominant_gray_criterion: DominantGrayCriterion,
    /// When a run ends, and how actions are chosen.
    pub navigator: NavigatorParams,
    /// Parameters of the localizer.
    pub localizer: ViewLocalizerParams,
    /// Appearance for views normalized by the whole scene, or not normalized.
    pub scene_normalized_appearance_learning: AppearanceLearningParams,
    /// Appearance for light that is estimated jointly with the place.
    pub light_estimated_appearance_learning: AppearanceLearningParams,
}

impl Default for ViewsParams {
    fn default() -> Self {
        Self {
            dominant_gray_criterion: DominantGrayCriterion::default(),
            navigator: NavigatorParams::default(),
            localizer: ViewLocalizerParams::default(),
            scene_normalized_appearance_learning: AppearanceLearningParams::normalized(),
            light_estimated_appearance_learning: AppearanceLearningParams::online(),
        }
    }
}

impl ViewsParams {
    /// The method of the paper: the light is normalized from the whole scene, and there is no kidnapping.
    pub fn as_published() -> Self {
        Self {
            localizer: ViewLocalizerParams::as_published(),
            scene_normalized_appearance_learning: AppearanceLearningParams::as_published(),
            ..Self::default()
        }
    }
}
