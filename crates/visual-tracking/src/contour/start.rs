use super::history::History;
use super::hypotheses::samples::Samples;
use super::reference::Reference;
use super::region::Region;
use super::{ColorContourTracker, ColorContourTrackerParams};
use crate::StructuringElement;
use crate::error::check_size;
use crate::picture::rgb_pixels;
use crate::{
    AffineSnake, BoundingBox, ColorBinSet, ColorCloud, ColorDynamics, ColorQuantizer, Outline,
    PixelConnectivity, PixelMask, RgbImage, TrackStatus, TrackingError,
};

/// Number of corners of the ellipse used for a target of unknown shape.
const N_ELLIPSE: usize = 80;

/// The blob in a box must agree with it that well (intersection over union of the boxes) to be the target.
const LEAST_IOU: f64 = 0.75;

/// Half the width of limbs that are excluded from the body, in sides of the box.
const LIMB: f64 = 0.08;

/// Minimum share of the convex hull that a body with notches fills; colours shared with the background cause notches.
const LEAST_SOLIDITY: f64 = 0.75;
const SOLID: f64 = 0.95;

impl ColorContourTracker {
    /// Starts from an outline in the first picture.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if a parameter is out of range, or [`TrackingError::Empty`] if no image pixel is inside.
    pub fn from_outline(
        picture: &RgbImage,
        outline: &Outline,
        params: ColorContourTrackerParams,
    ) -> Result<Self, TrackingError> {
        params.validate()?;
        let quantizer = ColorQuantizer::new(params.color_space, params.color_bins)?;
        let dynamics = ColorDynamics::constant_velocity(params.velocity_retention, &params.noise())?;
        let snake = AffineSnake::new(outline, &params.snake)?;
        let size = (picture.width() as usize, picture.height() as usize);
        let inside = PixelMask::from_polygon(size.0, size.1, outline.points())?;
        let of_target =
            rgb_pixels(picture).iter().enumerate().filter(|(i, _)| inside.get(i % size.0, i / size.0));
        let colors = of_target.map(|(_, pixel)| params.color_space.convert(*pixel));
        let cloud = ColorCloud::from_colors(colors, params.max_color_points)?;
        let reference = Reference::at_start(cloud, snake)?;
        let samples = Samples::at_start(&reference.colors, params.n_samples)?;
        let (history, status) = (History::at_start(&reference), TrackStatus::Tracked);
        Ok(Self { params, quantizer, dynamics, size, reference, history, samples, status })
    }

    /// Starts from a mask of the first picture, the largest blob in it.
    ///
    /// # Errors
    /// Returns the errors of [`from_outline`](Self::from_outline), and [`TrackingError::Dimension`] if mask and image differ in size.
    pub fn from_mask(
        picture: &RgbImage,
        mask: &PixelMask,
        params: ColorContourTrackerParams,
    ) -> Result<Self, TrackingError> {
        check_size("width of the mask", picture.width() as usize, mask.width())?;
        check_size("height of the mask", picture.height() as usize, mask.height())?;
        Self::from_outline(picture, &outline_of_mask(mask)?, params)
    }

    /// Starts from a box in the first image. The outline is that of the blob whose colours are more frequent inside the box than around it.
    /// If the blob does not fill the box, the inscribed ellipse is used.
    /// # Errors
    /// Returns the errors of [`from_outline`](Self::from_outline).
    pub fn from_box(
        picture: &RgbImage,
        bounds: &BoundingBox,
        params: ColorContourTrackerParams,
    ) -> Result<Self, TrackingError> {
        let quantizer = ColorQuantizer::new(params.color_space, params.color_bins)?;
        Self::from_outline(picture, &outline_in_box(picture, &quantizer, bounds)?, params)
    }
}

/// The outline of the target in a box: the blob of the colours that are more frequent in the inscribed ellipse than around the box,
/// without notches, if it fills the box, else the ellipse.
fn outline_in_box(
    picture: &RgbImage,
    quantizer: &ColorQuantizer,
    bounds: &BoundingBox,
) -> Result<Outline, TrackingError> {
    let ellipse = Outline::ellipse(bounds, N_ELLIPSE)?;
    let margin = 0.25 * (bounds.width() + bounds.height());
    let Some(region) = Region::around(picture, quantizer, bounds, margin)? else {
        return Err(TrackingError::Empty { what: "target in the picture" });
    };
    let [x, y] = bounds.corner();
    let (right, bottom) = (x + bounds.width(), y + bounds.height());
    let box_mask = region.inside(&[[x, y], [right, y], [right, bottom], [x, bottom]])?;
    let inner = region.shares(&region.inside(ellipse.points())?);
    let outer = region.shares(&box_mask.dilated(StructuringElement::Square { radius: 2 }).not());
    let set = ColorBinSet::from_fn(quantizer, |bin| inner[usize::from(bin)] > outer[usize::from(bin)]);
    // Closes small gaps in the colours of the target and removes thin parts.
    let limb = (LIMB * (bounds.width() * bounds.height()).sqrt()).max(1.0) as usize;
    let closed = region.segment(&set).and(&box_mask)?.closed(StructuringElement::Square { radius: 2 });
    let blobs = closed
        .without_holes(PixelConnectivity::Eight)
        .opened(StructuringElement::Square { radius: limb })
        .blobs(PixelConnectivity::Eight);
    let blob = blobs.largest().and_then(|largest| blobs.mask(largest));
    let body = blob.and_then(|mask| Outline::of_mask(&mask, region.rect.corner())).and_then(without_notches);
    Ok(body.filter(|body| body.bounding_box().iou(bounds) >= LEAST_IOU).unwrap_or(ellipse))
}

/// The outline of the largest blob of a full-size mask.
fn outline_of_mask(mask: &PixelMask) -> Result<Outline, TrackingError> {
    let blobs = mask.blobs(PixelConnectivity::Eight);
    let blob = blobs.largest().and_then(|largest| blobs.mask(largest));
    blob.and_then(|blob| Outline::of_mask(&blob, (0, 0)))
        .ok_or(TrackingError::Empty { what: "target in the mask" })
}

fn without_notches(blob: Outline) -> Option<Outline> {
    let hull = blob.convex_hull();
    match blob.area() / hull.area() {
        solidity if solidity >= SOLID => Some(blob),
        solidity if solidity >= LEAST_SOLIDITY => Some(hull),
        _ => None,
    }
}
