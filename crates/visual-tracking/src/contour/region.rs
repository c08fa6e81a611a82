use crate::PixelRect;
use crate::{BoundingBox, ColorBinImage, ColorBinSet, ColorQuantizer, PixelMask, RgbImage, TrackingError};

/// A part of a picture with the bins of its pixels.
pub(super) struct Region {
    pub(super) rect: PixelRect,
    pub(super) bins: ColorBinImage,
}

impl Region {
    /// The part of an image within `margin` pixels of a box; `None` if the box is outside.
    pub(super) fn around(
        picture: &RgbImage,
        quantizer: &ColorQuantizer,
        bounds: &BoundingBox,
        margin: f64,
    ) -> Result<Option<Self>, TrackingError> {
        let size = (picture.width() as usize, picture.height() as usize);
        if PixelRect::covering(bounds, size).is_none() {
            return Ok(None);
        }
        let (width, height) = (bounds.width() + 2.0 * margin, bounds.height() + 2.0 * margin);
        let wider = BoundingBox::from_center(bounds.center(), width, height)?;
        PixelRect::covering(&wider, size).map(|rect| Self::of(picture, quantizer, rect)).transpose()
    }

    /// The whole picture.
    pub(super) fn whole(picture: &RgbImage, quantizer: &ColorQuantizer) -> Result<Self, TrackingError> {
        Self::of(picture, quantizer, PixelRect::whole(picture))
    }

    fn of(picture: &RgbImage, quantizer: &ColorQuantizer, rect: PixelRect) -> Result<Self, TrackingError> {
        Ok(Self { rect, bins: ColorBinImage::within(quantizer, picture, &rect)? })
    }

    /// The pixels inside an outline.
    pub(super) fn inside(&self, outline: &[[f64; 2]]) -> Result<PixelMask, TrackingError> {
        let (left, top) = (self.rect.left as f64, self.rect.top as f64);
        let points: Vec<[f64; 2]> = outline.iter().map(|[u, v]| [u - left, v - top]).collect();
        PixelMask::from_polygon(self.rect.width, self.rect.height, &points)
    }

    /// For every bin, the share of the pixels of a mask that are in it; all 0 for a mask without pixels.
    pub(super) fn shares(&self, mask: &PixelMask) -> Vec<f32> {
        let mut counts = vec![0_f32; self.bins.n_bins()];
        let n_pixels = mask.area();
        for (v, row) in self.bins.rows().enumerate() {
            for (u, &bin) in row.iter().enumerate() {
                counts[usize::from(bin)] += f32::from(u8::from(mask.get(u, v)));
            }
        }
        if n_pixels > 0 {
            counts.iter_mut().for_each(|count| *count /= n_pixels as f32);
        }
        counts
    }

    /// The pixels of a set of bins.
    pub(super) fn segment(&self, set: &ColorBinSet) -> PixelMask {
        self.bins.segment(set).expect("invariant: one quantizer for all")
    }
}
