//! Likelihood of an image given a camera pose in a coloured map and the light.

mod choice;
mod density;
mod feature;
mod feature_params;
mod model;
mod occlusion;
mod params;
mod pixel;
mod span;
mod tile_fit;
mod tile_light;
mod tiles;
mod view;

pub use choice::{EitherLikelihood, ImageLikelihoodChoice};
pub use density::PixelSumDensity;
pub use feature::FeatureLikelihood;
pub(crate) use feature::feature_colors;
pub use feature_params::FeatureLikelihoodParams;
pub use model::{LikelihoodFrameInput, LikelihoodModel, PixelLikelihoodFrame, PredictedMapView, TileScratch};
pub use occlusion::ViewOcclusionModel;
pub(crate) use occlusion::or_hidden;
pub use params::{LightErrorCorrelation, PixelLikelihoodParams};
pub use pixel::PixelLikelihood;
pub(crate) use span::gather_tiles;
pub use span::{PixelSpanLikelihood, gather};
pub(crate) use tile_light::TileLight;
pub(crate) use tiles::{LightOfTiles, TileLikelihood};
pub use view::CameraPoseLikelihood;
