//! Camera views of a map, as spans of pixels.

mod bits;
mod canvas;
mod coverage;
mod map_renderer;
mod margin;
mod outline;
mod pose;
mod silhouette;
mod view;

pub use map_renderer::MapRenderer;
