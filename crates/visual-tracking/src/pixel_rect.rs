use image::RgbImage;

use crate::{BoundingBox, TrackingError};

/// A rectangle of whole pixels: columns `left .. left + width`, rows `top .. top + height`.
///
/// ```
/// use wayfix_visual_tracking::{BoundingBox, PixelRect};
/// let bounding_box = BoundingBox::from_corner(-3.0, 2.5, 10.0, 4.0)?;
/// let rect = PixelRect::covering(&bounding_box, (320, 240)).expect("a part of it is inside");
/// assert_eq!(rect, PixelRect { left: 0, top: 2, width: 7, height: 5 });
/// assert_eq!(rect.to_box()?.area(), 35.0);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// The first column.
    pub left: usize,
    /// The first row.
    pub top: usize,
    /// Number of columns; at least one in every rectangle that the crate returns.
    pub width: usize,
    /// Number of rows; at least one in every rectangle that the crate returns.
    pub height: usize,
}

impl PixelRect {
    /// The pixels that a box touches in an image of width and height `size`; none if it lies outside.
    pub fn covering(bounding_box: &BoundingBox, size: (usize, usize)) -> Option<Self> {
        let [x, y] = bounding_box.corner();
        let (left, width) = clipped(x, bounding_box.width(), size.0)?;
        let (top, height) = clipped(y, bounding_box.height(), size.1)?;
        Some(Self { left, top, width, height })
    }

    /// All of a picture.
    pub fn whole(picture: &RgbImage) -> Self {
        Self { left: 0, top: 0, width: picture.width() as usize, height: picture.height() as usize }
    }

    /// The column and row of the top left pixel.
    pub fn corner(&self) -> (usize, usize) {
        (self.left, self.top)
    }

    /// Width and height.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The smallest rectangle that contains both.
    pub fn union(&self, other: &Self) -> Self {
        let (left, width) = joined((self.left, self.width), (other.left, other.width));
        let (top, height) = joined((self.top, self.height), (other.top, other.height));
        Self { left, top, width, height }
    }

    /// The same rectangle as a box.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] without columns or rows.
    pub fn to_box(&self) -> Result<BoundingBox, TrackingError> {
        let [x, y, width, height] = [self.left, self.top, self.width, self.height].map(|n| n as f64);
        BoundingBox::from_corner(x, y, width, height)
    }
}

/// The whole pixels of `start .. start + len` in `0 .. limit`: the first one and their number. The conversion saturates.
fn clipped(start: f64, len: f64, limit: usize) -> Option<(usize, usize)> {
    let first = (start.floor() as usize).min(limit);
    let end = ((start + len).ceil() as usize).min(limit);
    (first < end).then(|| (first, end - first))
}

/// From the earlier start to the later end, as start and length.
fn joined(a: (usize, usize), b: (usize, usize)) -> (usize, usize) {
    let start = a.0.min(b.0);
    (start, a.0.saturating_add(a.1).max(b.0.saturating_add(b.1)) - start)
}
