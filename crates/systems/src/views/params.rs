use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_condensation::{AppearanceParams, Dominance, LocalizerParams, NavigatorParams};

use crate::settings::over_defaults;

/// Everything that `wayfix run views` is tuned by; none of it depends on the scene.
///
/// ```
/// use wayfix_systems::views::ViewsParams;
/// let params = ViewsParams::from_toml("[navigator]\nmax_steps = 40")?;
/// assert_eq!((params.navigator.max_steps, params.navigator.confirmations), (40, 3)); // the rest as it was
/// assert!(ViewsParams::from_toml("[navigator]\nmax_stesp = 40").is_err());
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViewsParams {
    /// What the numbers of `hist6` are.
    pub dominance: Dominance,
    /// When a run ends, and how actions are chosen.
    pub navigator: NavigatorParams,
    /// What is assumed of a run.
    pub localizer: LocalizerParams,
    /// What is learned for views normalized by the whole scene, or not at all.
    pub whole_scene: AppearanceParams,
    /// What is learned for light that is estimated together with the place.
    pub online: AppearanceParams,
}

impl Default for ViewsParams {
    fn default() -> Self {
        Self {
            dominance: Dominance::default(),
            navigator: NavigatorParams::default(),
            localizer: LocalizerParams::default(),
            whole_scene: AppearanceParams::normalized(),
            online: AppearanceParams::online(),
        }
    }
}

impl ViewsParams {
    /// The defaults, with what a TOML text names in their place.
    ///
    /// # Errors
    /// When the text is no TOML, or names a key that does not exist or a value of another kind.
    pub fn from_toml(text: &str) -> Result<Self, toml::de::Error> {
        over_defaults(&Self::default(), text)
    }
}
