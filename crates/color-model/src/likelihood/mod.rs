//! Likelihood of an image given a camera pose in a coloured map and the light.

mod choice;
mod density;
mod feature;
mod feature_params;
mod joint;
mod model;
mod occlusion;
mod params;
mod pixel;
mod span;
mod view;

pub use choice::{EitherLikelihood, ImageLikelihoodChoice};
pub use density::PixelSumDensity;
pub use feature::FeatureLikelihood;
pub(crate) use feature::feature_colors;
pub use feature_params::FeatureLikelihoodParams;
pub(crate) use joint::JointLikelihood;
pub use model::{
    LikelihoodFrameInput, LikelihoodModel, PixelLikelihoodFrame, PixelLikelihoodScratch, PredictedMapView,
};
pub use occlusion::ViewOcclusionModel;
pub(crate) use occlusion::or_hidden;
pub use params::{LightErrorCorrelation, PixelLikelihoodParams};
pub use pixel::PixelLikelihood;
pub use span::{PixelSpanLikelihood, gather};
pub use view::CameraPoseLikelihood;
