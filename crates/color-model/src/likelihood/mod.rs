//! Likelihood of an image given a camera pose in a coloured map and the light.

mod density;
mod feature;
mod feature_params;
mod joint;
mod model;
mod params;
mod pixel;
mod span;
mod view;

pub use density::SumDensity;
pub use feature::FeatureLikelihood;
pub(crate) use feature::feature_colors;
pub use feature_params::FeatureParams;
pub(crate) use joint::JointLikelihood;
pub use model::{FrameContext, JointScratch, LikelihoodModel, PixelFrame, PoseView};
pub use params::{PixelLight, PixelParams};
pub use pixel::PixelLikelihood;
pub use span::{SpanLikelihood, gather};
pub use view::ViewLikelihood;
