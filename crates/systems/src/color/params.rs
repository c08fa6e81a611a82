use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_color_model::{Background, Drift, LocalizerParams, Unseen, YuvStandard};

/// Everything that `wayfix run color` is tuned by. What a file of parameters does not name keeps its default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ColorSystemParams {
    /// What YUV is.
    pub yuv: YuvStandard,
    /// Variance of the pixels of a colour in an image (Y, U, V), in place of the one that belongs to the priors.
    pub pixel_noise: Option<[f64; 3]>,
    /// Variance of an image's mean of a colour (Y, U, V), in place of the one that belongs to the priors.
    pub mean_noise: Option<[f64; 3]>,
    /// How the light changes by itself.
    pub drift: Drift,
    /// What becomes of colours that an image does not show.
    pub unseen: Unseen,
    /// Probability that the light is not switched from one frame to the next.
    pub light_persistence: f64,
    /// By how much odometry is stamped later than images that show the same, s; negative where it is stamped earlier.
    pub odometry_delay: f64,
    /// What is known of the start where the log has true poses.
    pub start: StartParams,
    /// The particle filter.
    pub localizer: LocalizerParams,
    /// What shows nothing of the map.
    #[serde(skip)]
    pub background: Background,
}

/// What is known of the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StartParams {
    /// Standard deviation of the position, metres.
    pub position_sigma: f64,
    /// Standard deviation of the heading, radians.
    pub heading_sigma: f64,
}

impl Default for StartParams {
    fn default() -> Self {
        Self { position_sigma: 0.5, heading_sigma: 0.3 }
    }
}

impl Default for ColorSystemParams {
    fn default() -> Self {
        Self {
            yuv: YuvStandard::Bt601Full,
            pixel_noise: None,
            mean_noise: None,
            drift: Drift::TowardsPrior(120.0),
            unseen: Unseen::Marginalize,
            light_persistence: 0.98,
            odometry_delay: 0.0,
            start: StartParams::default(),
            localizer: LocalizerParams::default(),
            background: Background::Uniform,
        }
    }
}
