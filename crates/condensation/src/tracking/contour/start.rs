use super::region::Region;
use crate::tracking::Element;
use crate::{
    BinSet, BitMask, BoundingBox, ColorQuantizer, CondensationError, Connectivity, Outline, Picture,
};

/// Corners of the ellipse that stands for a target of unknown shape.
const N_ELLIPSE: usize = 80;

/// The blob in a box must agree with it that well (intersection over union of the boxes) to be the target.
const LEAST_IOU: f64 = 0.75;

/// Half the width of limbs that are no part of the body, in sides of the box.
const LIMB: f64 = 0.08;

/// It must fill so much of its convex hull to be a body with some notches, which a few colours that the target shares with what is
/// behind it leave; and so much not to have any.
const LEAST_SOLIDITY: f64 = 0.75;
const SOLID: f64 = 0.95;

/// The outline of what a box is drawn round: the blob of the colours that are more frequent in the ellipse in the box than round the box,
/// without notches, if it fills the box, else that ellipse.
pub(super) fn outline_in_box(
    picture: &Picture,
    quantizer: &ColorQuantizer,
    bounds: &BoundingBox,
) -> Result<Outline, CondensationError> {
    let ellipse = Outline::ellipse(bounds, N_ELLIPSE)?;
    let margin = 0.25 * (bounds.width() + bounds.height());
    let Some(region) = Region::around(picture, quantizer, bounds, margin)? else {
        return Err(CondensationError::Empty { what: "target in the picture" });
    };
    let [x, y] = bounds.corner();
    let (right, bottom) = (x + bounds.width(), y + bounds.height());
    let box_mask = region.inside(&[[x, y], [right, y], [right, bottom], [x, bottom]])?;
    let inner = region.shares(&region.inside(ellipse.points())?);
    let outer = region.shares(&box_mask.dilated(Element::Square { radius: 2 }).not());
    let set = BinSet::from_fn(quantizer, |bin| inner[usize::from(bin)] > outer[usize::from(bin)]);
    // Closes small gaps in the colours of the target and cuts off what is thin beside it.
    let limb = (LIMB * (bounds.width() * bounds.height()).sqrt()).max(1.0) as usize;
    let closed = region.segment(&set).and(&box_mask)?.closed(Element::Square { radius: 2 });
    let blobs = closed
        .without_holes(Connectivity::Eight)
        .opened(Element::Square { radius: limb })
        .blobs(Connectivity::Eight);
    let blob = blobs.largest().and_then(|largest| blobs.mask(largest));
    let body = blob.and_then(|mask| Outline::of_mask(&mask, region.rect.corner())).and_then(without_notches);
    Ok(body.filter(|body| body.bounding_box().iou(bounds) >= LEAST_IOU).unwrap_or(ellipse))
}

/// The outline of the largest blob of a mask as large as a picture.
pub(super) fn outline_of_mask(mask: &BitMask) -> Result<Outline, CondensationError> {
    let blobs = mask.blobs(Connectivity::Eight);
    let blob = blobs.largest().and_then(|largest| blobs.mask(largest));
    blob.and_then(|blob| Outline::of_mask(&blob, (0, 0)))
        .ok_or(CondensationError::Empty { what: "target in the mask" })
}

fn without_notches(blob: Outline) -> Option<Outline> {
    let hull = blob.convex_hull();
    match blob.area() / hull.area() {
        solidity if solidity >= SOLID => Some(blob),
        solidity if solidity >= LEAST_SOLIDITY => Some(hull),
        _ => None,
    }
}
