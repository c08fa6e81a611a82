use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_visual_tracking::{ContourTrackerParams, CorrelationTrackerParams, HeadTrackerParams};

use crate::settings::over_defaults;

/// Parameters of `wayfix run track`, independent of the recording.
///
/// ```
/// use wayfix_systems::track::TrackParams;
/// let params = TrackParams::from_toml("[contour]\nn_samples = 50")?;
/// assert_eq!((params.contour.n_samples, params.contour.adapts_colors), (50, true)); // the rest as it was
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
    /// The head and contour trackers as published; the box tracker is not of the paper.
    pub fn as_published() -> Self {
        Self {
            head: HeadTrackerParams::as_published(),
            contour: ContourTrackerParams::as_published(),
            ..Self::default()
        }
    }

    /// The defaults, overridden by the values of a TOML text.
    ///
    /// # Errors
    /// Returns an error if the text is not valid TOML, or contains an unknown key or a value of the wrong type.
    pub fn from_toml(text: &str) -> Result<Self, toml::de::Error> {
        over_defaults(&Self::default(), text)
    }
}
