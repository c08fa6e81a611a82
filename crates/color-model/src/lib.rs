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

pub use background::Background;
pub use classify::{Blob, Classifier, LookUpTable, find_blobs};
pub use error::ColorModelError;
pub use frame::{Frame, PixelSums};
pub use lighting::{
    Choice, ColorDensity, ColorMeans, Drift, Gpb2Tracker, ImmTracker, JumpMarkovTracker, LightTracker,
    LightingBank, LightingFilter, LightingParams, Unseen,
};
pub use likelihood::{
    FeatureLikelihood, FeatureParams, FrameContext, JointScratch, LikelihoodModel, PixelFrame, PixelLight,
    PixelLikelihood, PixelParams, PoseView, SpanLikelihood, SumDensity, ViewLikelihood, gather,
};
pub use localizer::{
    CameraError, CameraLocation, CameraNoise, ColorLocalizer, Fix, FrameOutcome, LocalizerParams, Occlusion,
    OdometryModel, OdometryNoise, OdometryStep, PoseEstimate, SearchParams, Start,
};
pub use prior::{
    KMeans, LightingPriors, PixelSpread, PriorError, PriorParams, TrainingVenue, k_means, learn_priors,
    split_by_brightness,
};
pub use yuv::{YuvImage, YuvStandard};
