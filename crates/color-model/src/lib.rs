//! Colours under unknown light: adaptive colour models, and localization in coloured maps.

mod background;
mod classify;
mod error;
mod frame;
mod lighting;
mod likelihood;
mod localizer;
mod prior;
mod yuv;

pub use background::BackgroundColorModel;
pub use classify::{ColorBlob, ColorLookUpTable, PixelClassifier, find_blobs};
pub use error::ColorModelError;
pub use frame::{PixelSums, PrefixSumImage};
pub use lighting::{
    ColorDensity, ColorMeans, Gpb2LightingTracker, ImmLightingTracker, JumpMarkovLightingTracker,
    LightingBank, LightingDrift, LightingFilter, LightingFilterParams, LightingTracker,
    SelectedLightingFilter, UnseenColorRule,
};
pub use likelihood::{
    CameraPoseLikelihood, FeatureLikelihood, FeatureLikelihoodParams, LightErrorCorrelation, PixelLikelihood,
    PixelLikelihoodParams, PixelSpanLikelihood, PixelSumDensity, gather,
};
pub use localizer::{
    AcquisitionParams, CameraError, CameraLocation, CameraNoise, ColorLocalizer, Fix, FrameOutcome,
    HiddenViews, LocalizerParams, OdometryNoise, OdometryStep, PoseEstimate, Start,
};
pub use prior::{
    KMeans, LightingPriorError, LightingPriors, PooledPixelVariance, PriorLearningParams, TrainingVenue,
    k_means, learn_priors, split_by_brightness,
};
pub use yuv::{YuvImage, YuvStandard};
