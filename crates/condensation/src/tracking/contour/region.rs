use crate::tracking::PixelRect;
use crate::{BinImage, BinSet, BitMask, BoundingBox, ColorQuantizer, CondensationError, Picture};

/// A part of a picture with the bins of its pixels.
pub(super) struct Region {
    pub(super) rect: PixelRect,
    pub(super) bins: BinImage,
}

impl Region {
    /// The part of a picture within `margin` pixels of a box; none when the box itself is outside.
    pub(super) fn around(
        picture: &Picture,
        quantizer: &ColorQuantizer,
        bounds: &BoundingBox,
        margin: f64,
    ) -> Result<Option<Self>, CondensationError> {
        let size = (picture.width(), picture.height());
        if PixelRect::covering(bounds, size).is_none() {
            return Ok(None);
        }
        let (width, height) = (bounds.width() + 2.0 * margin, bounds.height() + 2.0 * margin);
        let wider = BoundingBox::from_center(bounds.center(), width, height)?;
        PixelRect::covering(&wider, size).map(|rect| Self::of(picture, quantizer, rect)).transpose()
    }

    /// The whole picture.
    pub(super) fn whole(picture: &Picture, quantizer: &ColorQuantizer) -> Result<Self, CondensationError> {
        let rect = PixelRect { left: 0, top: 0, width: picture.width(), height: picture.height() };
        Self::of(picture, quantizer, rect)
    }

    fn of(picture: &Picture, quantizer: &ColorQuantizer, rect: PixelRect) -> Result<Self, CondensationError> {
        let view = picture.view(rect.corner(), rect.size())?;
        Ok(Self { rect, bins: BinImage::new(quantizer, &view)? })
    }

    /// The pixels inside an outline.
    pub(super) fn inside(&self, outline: &[[f64; 2]]) -> Result<BitMask, CondensationError> {
        let (left, top) = (self.rect.left as f64, self.rect.top as f64);
        let points: Vec<[f64; 2]> = outline.iter().map(|[u, v]| [u - left, v - top]).collect();
        BitMask::from_polygon(self.rect.width, self.rect.height, &points)
    }

    /// For every bin, the share of the pixels of a mask that are in it; all 0 for a mask without pixels.
    pub(super) fn shares(&self, mask: &BitMask) -> Vec<f32> {
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
    pub(super) fn segment(&self, set: &BinSet) -> BitMask {
        self.bins.segment(set).expect("invariant: one quantizer for all")
    }
}
