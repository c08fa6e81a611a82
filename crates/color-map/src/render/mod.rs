//! Camera views of a map, as spans of pixels.

mod bits;
mod canvas;
mod coverage;
mod margin;
mod outline;
mod pose;
mod projector;
mod silhouette;
mod view;

pub use projector::MapRenderer;
