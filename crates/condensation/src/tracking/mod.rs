//! A target followed from picture to picture while the light changes.

mod bounding_box;
mod color;
mod correlation;
mod contour;
mod distribution;
mod mask;
mod pixel_rect;
mod snake;
mod tracker;

pub use bounding_box::BoundingBox;
pub use color::{BinImage, BinSet, ColorHistogram, ColorQuantizer, ColorSpace, RowSpans, SlidingHistogram};
pub use correlation::{CorrelationTracker, CorrelationTrackerParams};
pub use contour::{Agreement, ContourTracker, ContourTrackerParams, TrackingCues};
pub use distribution::{
    COLOR_DIM, ColorCloud, ColorDynamics, ColorState, ColorVector, ColorWarp, LearnedDynamics,
    PrincipalColors,
};
pub use mask::{BitMask, Blob, Blobs, Connectivity, Element};
pub use pixel_rect::PixelRect;
pub use snake::{AffineMap, AffineSnake, ColorEdges, EdgeSearch, MaskEdges, Outline, SnakeFit, SnakeParams};
pub use tracker::{Target, TrackStatus, Tracker};
