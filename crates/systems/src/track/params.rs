use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_visual_tracking::{ColorContourTrackerParams, CorrelationTrackerParams, HeadTrackerParams};

/// Parameters of `wayfix run track`, independent of the recording.
///
/// ```
/// use wayfix_system_core::settings::from_toml;
/// use wayfix_systems::track::TrackParams;
/// let params = from_toml::<TrackParams>("[contour]\nn_samples = 50")?;
/// assert_eq!((params.contour.n_samples, params.contour.adapts_colors), (50, true)); // the rest as it was
/// assert!(from_toml::<TrackParams>("[contour]\nn_smaples = 50").is_err());
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
    pub contour: ColorContourTrackerParams,
}

impl TrackParams {
    /// The head and contour trackers as published; the box tracker is not of the paper.
    pub fn as_published() -> Self {
        Self {
            head: HeadTrackerParams::as_published(),
            contour: ColorContourTrackerParams::as_published(),
            ..Self::default()
        }
    }
}
