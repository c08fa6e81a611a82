//! A target followed from picture to picture while the light changes.

mod bounding_box;
mod color;
mod contour;
mod correlation;
mod distribution;
mod head;
mod mask;
mod mean_shift;
mod pixel_rect;
mod snake;
mod tracker;

pub use bounding_box::BoundingBox;
pub use color::{BinImage, BinSet, ColorHistogram, ColorQuantizer, ColorSpace, RowSpans, SlidingHistogram};
pub use contour::{Agreement, ContourTracker, ContourTrackerParams, TrackingCues};
pub use correlation::{CorrelationTracker, CorrelationTrackerParams};
pub use distribution::{
    COLOR_DIM, ColorCloud, ColorDynamics, ColorState, ColorVector, ColorWarp, LearnedDynamics,
    PrincipalColors,
};
pub use head::{HeadTracker, HeadTrackerParams, LocalScale, ScaleSource};
pub use mask::{BitMask, Blob, Blobs, Connectivity, Element};
pub use mean_shift::{BackProjection, MeanShift, MeanShiftParams, Moments};
pub use pixel_rect::PixelRect;
pub use snake::{AffineMap, AffineSnake, ColorEdges, EdgeSearch, MaskEdges, Outline, SnakeFit, SnakeParams};
pub use tracker::{Target, TrackStatus, Tracker};
