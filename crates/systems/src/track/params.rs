use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_visual_tracking::{ContourTrackerParams, CorrelationTrackerParams, HeadTrackerParams};

use crate::settings::over_defaults;

/// Everything that `wayfix run track` is tuned by; none of it depends on the recording.
///
/// ```
/// use wayfix_systems::track::TrackParams;
/// let params = TrackParams::from_toml("[contour]\nn_samples = 50")?;
/// assert_eq!((params.contour.n_samples, params.contour.adapts), (50, true)); // the rest as it was
/// assert!(TrackParams::from_toml("[contour]\nn_smaples = 50").is_err());
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrackParams {
    /// The box tracker.
    pub correlation: CorrelationTrackerParams,
    /// The head tracker.
    pub head: HeadTrackerParams,
    /// The contour tracker.
    pub contour: ContourTrackerParams,
}

impl TrackParams {
    /// The defaults, with what a TOML text names in their place.
    ///
    /// # Errors
    /// When the text is no TOML, or names a key that does not exist or a value of another kind.
    pub fn from_toml(text: &str) -> Result<Self, toml::de::Error> {
        over_defaults(&Self::default(), text)
    }
}
