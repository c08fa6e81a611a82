use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_color_model::{
    BackgroundColorModel, FeatureLikelihoodParams, ImageLikelihoodChoice, LightingDrift, LocalizerParams,
    UnseenColorRule, YuvStandard,
};

/// Parameters of `wayfix run color`. Keys that a parameter file omits keep their defaults.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ColorSystemParams {
    /// The YUV standard of the images.
    pub yuv_standard: YuvStandard,
    /// Variance of a colour's pixels within an image (Y, U, V); overrides that of the priors.
    pub pixel_color_variance: Option<[f64; 3]>,
    /// Variance of a colour's mean in an image (Y, U, V); overrides that of the priors.
    pub mean_color_variance: Option<[f64; 3]>,
    /// Process noise of the light.
    pub lighting_drift: LightingDrift,
    /// Treatment of colours that an image does not show.
    pub unseen_colors: UnseenColorRule,
    /// Probability that the light does not switch between two frames. Default 0.98: a switch costs 4 nats, less than a few tiles say.
    pub light_persistence: f64,
    /// Delay of the odometry stamps relative to images of the same motion, s; negative if odometry is stamped early.
    pub odometry_delay: f64,
    /// Uncertainty of the start pose, if the log has true poses.
    pub start_uncertainty: StartPoseUncertainty,
    /// The particle filter.
    pub localizer: LocalizerParams,
    /// Weighs particles by the blobs of the image instead of all its pixels; the search uses pixels. Default none.
    pub feature_likelihood: Option<FeatureLikelihoodParams>,
    /// Model of the pixels that show no map surface.
    #[serde(skip)]
    pub background_model: BackgroundColorModel,
}

impl ColorSystemParams {
    /// The likelihood of the particles.
    pub(crate) fn likelihood(&self) -> ImageLikelihoodChoice {
        self.feature_likelihood
            .map_or(ImageLikelihoodChoice::Pixels(self.localizer.pixels), ImageLikelihoodChoice::Features)
    }

    /// Sets the method as published, without blobs. Odometry, camera, and the variances and the drift of the light stay: they describe the robot and the hall.
    pub fn set_published(&mut self) {
        self.unseen_colors = UnseenColorRule::Regress;
        self.feature_likelihood = None;
        let LocalizerParams { odometry, camera_pose_noise, .. } = self.localizer;
        self.localizer = LocalizerParams { odometry, camera_pose_noise, ..LocalizerParams::as_published() };
    }
}

/// Uncertainty of the start pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StartPoseUncertainty {
    /// Standard deviation of the position, m. Default 0.5: a person puts the robot down.
    pub position_sigma: f64,
    /// Standard deviation of the heading, rad. Default 0.3.
    pub heading_sigma: f64,
}

impl Default for StartPoseUncertainty {
    fn default() -> Self {
        Self { position_sigma: 0.5, heading_sigma: 0.3 }
    }
}

impl Default for ColorSystemParams {
    fn default() -> Self {
        Self {
            yuv_standard: YuvStandard::Bt601Full,
            pixel_color_variance: None,
            mean_color_variance: None,
            lighting_drift: LightingDrift::TowardsPrior(120.0),
            unseen_colors: UnseenColorRule::Marginalize,
            light_persistence: 0.98,
            odometry_delay: 0.0,
            start_uncertainty: StartPoseUncertainty::default(),
            localizer: LocalizerParams::default(),
            feature_likelihood: None,
            background_model: BackgroundColorModel::Uniform,
        }
    }
}
