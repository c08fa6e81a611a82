use clap::ValueEnum;
use serde::Deserialize;
use wayfix_visual_tracking::{
    ColorContourTracker, CorrelationTracker, HeadTracker, RgbImage, TrackingCues, TrackingError,
};

use super::{FrameTracker, InitialTargetRegion, TrackParams, frame_tracker::ContourFrameTracker};

/// Tracking method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TrackingMethod {
    /// A correlation filter over gradients and colours: a box around any target.
    #[default]
    Box,
    /// An ellipse fitted by its colours and its rim, such as a head in a room.
    Head,
    /// CONDENSATION in colour space, validated by an affine contour: the outline of a target of arbitrary shape.
    Contour,
    /// The same with colours fixed at the start.
    ContourFixedColors,
    /// The same without the contour: the target is the blob of its colours.
    ContourColorOnly,
    /// The same without colours: a snake on the image edges.
    ContourShapeOnly,
}

impl TrackingMethod {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Head => "head",
            Self::Contour => "contour",
            Self::ContourFixedColors => "contour-fixed-colors",
            Self::ContourColorOnly => "contour-color-only",
            Self::ContourShapeOnly => "contour-shape-only",
        }
    }

    /// Starts a tracker in the first image.
    ///
    /// # Errors
    /// Returns the tracker's error if its start or its parameters are invalid.
    pub fn begin(
        self,
        params: &TrackParams,
        picture: &RgbImage,
        start: &InitialTargetRegion,
    ) -> Result<Box<dyn FrameTracker>, TrackingError> {
        let mut contour = params.contour;
        match self {
            Self::Box => {
                let bounds = start.box_in(picture)?;
                let tracker = CorrelationTracker::new(picture, bounds, params.correlation.clone())?;
                return Ok(Box::new(tracker));
            }
            Self::Head => {
                let bounds = start.box_in(picture)?;
                return Ok(Box::new(HeadTracker::new(picture, bounds, params.head.clone())?));
            }
            Self::Contour => {}
            Self::ContourFixedColors => contour.adapts_colors = false,
            Self::ContourColorOnly => contour.cues = TrackingCues::Color,
            Self::ContourShapeOnly => contour.cues = TrackingCues::Shape,
        }
        let tracker = match start {
            InitialTargetRegion::Box(bounds) => ColorContourTracker::from_box(picture, bounds, contour)?,
            InitialTargetRegion::Mask(mask) => ColorContourTracker::from_mask(picture, mask, contour)?,
        };
        Ok(Box::new(ContourFrameTracker { tracker, space: contour.color_space }))
    }
}
