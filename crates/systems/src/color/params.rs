use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_color_model::{Background, Drift, LocalizerParams, Unseen, YuvStandard};

/// Parameters of `wayfix run color`. Keys that a parameter file omits keep their defaults.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ColorSystemParams {
    /// The YUV standard of the images.
    pub yuv: YuvStandard,
    /// Variance of a colour's pixels within an image (Y, U, V); overrides that of the priors.
    pub pixel_noise: Option<[f64; 3]>,
    /// Variance of a colour's mean in an image (Y, U, V); overrides that of the priors.
    pub mean_noise: Option<[f64; 3]>,
    /// Process noise of the light.
    pub drift: Drift,
    /// Treatment of colours that an image does not show.
    pub unseen: Unseen,
    /// Probability that the light does not switch between two frames.
    pub light_persistence: f64,
    /// Delay of the odometry stamps relative to images of the same motion, s; negative if odometry is stamped early.
    pub odometry_delay: f64,
    /// Uncertainty of the start pose, if the log has true poses.
    pub start: StartParams,
    /// The particle filter.
    pub localizer: LocalizerParams,
    /// Model of the pixels that show no map surface.
    #[serde(skip)]
    pub background: Background,
}

/// Uncertainty of the start pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StartParams {
    /// Standard deviation of the position, m.
    pub position_sigma: f64,
    /// Standard deviation of the heading, rad.
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
