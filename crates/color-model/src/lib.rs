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
pub use frame::{PixelSums, PrefixSumImage, TileRegion, TileSums, TiledImage};
pub use lighting::{
    ColorDensity, ColorMeans, Gpb2LightingTracker, ImmLightingTracker, JumpMarkovLightingTracker,
    LightingDrift, LightingFilter, LightingFilterBank, LightingFilterParams, LightingTracker,
    SelectedLightingFilter, SunAndShade, UnseenColorRule,
};
pub use likelihood::{
    CameraPoseLikelihood, EitherLikelihood, FeatureLikelihood, FeatureLikelihoodParams,
    ImageLikelihoodChoice, LightErrorCorrelation, LikelihoodFrameInput, LikelihoodModel, PixelLikelihood,
    PixelLikelihoodFrame, PixelLikelihoodParams, PixelSpanLikelihood, PixelSumDensity, PredictedMapView,
    TileScratch, ViewOcclusionModel, gather,
};
pub use localizer::{
    CameraLocation, CameraPoseError, CameraPoseNoise, ColorLocalizer, ColorLocalizerModels, FrameOutcome,
    GlobalSearchParams, LocalizationStatus, LocalizerParams, OdometryModel, OdometryNoise, OdometryStep,
    PoseEstimate, StartPosePrior,
};
pub use prior::{
    KMeans, LabelledPixels, LightingPriorError, LightingPriors, PooledPixelVariance, PriorLearningParams,
    TrainingVenue, inner_labels, k_means, learn_grouped_priors, learn_priors, split_by_brightness,
};
pub use yuv::{YuvImage, YuvStandard};
