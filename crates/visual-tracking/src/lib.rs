//! A target followed from picture to picture while the light changes.
//!
//! | part | content |
//! | --- | --- |
//! | trackers | [`Tracker`]: [`CorrelationTracker`] (a box around anything), [`HeadTracker`] (an ellipse by colours and rim), [`ColorContourTracker`] (an outline) |
//! | colours | bins of a [`ColorSpace`]: [`ColorQuantizer`], [`ColorBinImage`], [`ColorHistogram`], [`SlidingHistogram`] |
//! | camera on a pan/tilt head | [`ActiveTracker`], [`PanTiltHead`] |
//! | masks | [`PixelMask`] with 64 pixels a word: morphology, Euler number, [`Blobs`] |
//! | contours | [`Outline`], [`AffineSnake`] on [`ColorEdgeSearch`] or [`MaskEdgeSearch`] |
//! | colour distributions | [`ColorCloud`], [`PrincipalColors`], [`ColorDynamics`], learned by [`LearnedColorDynamics`] |
//!
//! Andrade-Cetto, *Perception Issues in Mobile Robotics*, section 3. Pictures are [`RgbImage`]s of the crate `image`; no files are opened.

mod bounding_box;
mod color;
mod contour;
mod correlation;
mod distribution;
mod error;
mod head;
mod mask;
mod pan_tilt;
mod picture;
mod pixel_rect;
mod snake;
mod tracker;

pub use bounding_box::BoundingBox;
pub use color::{
    ColorBinImage, ColorBinSet, ColorHistogram, ColorQuantizer, ColorSpace, CustomColorSpace, RowSpans,
    SlidingHistogram,
};
pub use contour::{ColorContourTracker, ColorContourTrackerParams, ColorHypothesisAgreement, TrackingCues};
pub use correlation::{CorrelationTracker, CorrelationTrackerParams};
pub use distribution::{
    AffineColorMap, COLOR_DIM, ColorCloud, ColorDistributionState, ColorDynamics, ColorStateVector,
    LearnedColorDynamics, PrincipalColors,
};
pub use error::TrackingError;
pub use head::{
    DistanceScale, HeadDetector, HeadSizeFromSearch, HeadTracker, HeadTrackerParams, RelativeHeadSizeSource,
};
pub use image::RgbImage;
pub use mask::{Blob, Blobs, PixelConnectivity, PixelMask, StructuringElement};
pub use pan_tilt::{ActiveEstimate, ActiveTracker, PanTiltAim, PanTiltHead, PanTiltLimits, SimulatedPanTilt};
pub use pixel_rect::PixelRect;
pub use snake::{
    AffineMap, AffineSnake, ColorEdgeSearch, EdgeSearch, MaskEdgeSearch, Outline, SnakeFit, SnakeParams,
};
pub use tracker::{TargetEstimate, TrackStatus, Tracker};
