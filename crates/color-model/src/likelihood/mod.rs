//! How well an image fits a camera pose in a coloured map, under given light.

mod density;
mod joint;
mod params;
mod pixel;
mod span;
mod view;

pub use density::SumDensity;
pub(crate) use joint::JointLikelihood;
pub use params::{PixelLight, PixelParams};
pub use pixel::PixelView;
pub(crate) use span::log_likelihood;
pub use span::{SpanView, gather};
pub use view::ViewLikelihood;
