//! A contour that moves only by affine maps.

mod affine_map;
mod affine_snake;
mod edges;
mod fit;
mod outline;

pub use affine_map::AffineMap;
pub use affine_snake::{AffineSnake, SnakeFit, SnakeParams};
pub use edges::{ColorEdgeSearch, EdgeSearch, MaskEdgeSearch};
pub use outline::Outline;
