use super::ColorQuantizer;
use crate::mask::check_extent;
use crate::picture::rgb_pixels;
use crate::{PixelRect, TrackingError};
use image::RgbImage;

/// The colour bin of every pixel of a picture or a part of it, computed once for all hypotheses about it.
///
/// Pixels are counted from the corner of the part.
///
/// ```
/// use wayfix_visual_tracking::{ColorBinImage, ColorBinSet, ColorQuantizer, ColorSpace, RgbImage};
/// let picture = RgbImage::from_raw(3, 1, vec![255, 0, 0, 0, 0, 255, 250, 9, 0]).expect("3 bytes a pixel");
/// let quantizer = ColorQuantizer::new(ColorSpace::Rgb, [8, 8, 8])?;
/// let image = ColorBinImage::new(&quantizer, &picture)?;
/// let reddish = ColorBinSet::from_points(&quantizer, [[1.0, 0.0, 0.0]]);
/// let mask = image.segment(&reddish)?;
/// assert_eq!([0, 1, 2].map(|u| mask.get(u, 0)), [true, false, true]);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColorBinImage {
    width: usize,
    n_bins: usize,
    bins: Vec<u16>,
}

impl ColorBinImage {
    /// The bins of a picture.
    ///
    /// # Errors
    /// Returns [`TrackingError::Extent`] if the picture has no pixels, or more than a [`PixelMask`](crate::PixelMask) may have.
    pub fn new(quantizer: &ColorQuantizer, picture: &RgbImage) -> Result<Self, TrackingError> {
        Self::within(quantizer, picture, &PixelRect::whole(picture))
    }

    /// The bins of a part of a picture.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new), and [`TrackingError::Outside`] if the part exceeds the image.
    pub fn within(
        quantizer: &ColorQuantizer,
        picture: &RgbImage,
        rect: &PixelRect,
    ) -> Result<Self, TrackingError> {
        let PixelRect { left, top, width, height } = *rect;
        check_extent(width, height)?;
        let size = PixelRect::whole(picture).size();
        let end = (left.saturating_add(width), top.saturating_add(height));
        if end.0 > size.0 || end.1 > size.1 {
            return Err(TrackingError::Outside { pixel: end, size });
        }
        let mut bins = vec![0; width * height];
        let rows = rgb_pixels(picture).chunks_exact(size.0).skip(top);
        for (row, pixels) in bins.chunks_exact_mut(width).zip(rows) {
            quantizer.bins_of_pixels(&pixels[left..end.0], row);
        }
        Ok(Self { width, n_bins: quantizer.n_bins(), bins })
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.bins.len() / self.width
    }

    /// Number of bins.
    pub fn n_bins(&self) -> usize {
        self.n_bins
    }

    /// The bins of all pixels, row by row.
    pub fn bins(&self) -> &[u16] {
        &self.bins
    }

    /// Rows of bins, from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[u16]> {
        self.bins.chunks_exact(self.width)
    }

    /// One row of bins; the caller ensures that it exists.
    pub(super) fn row(&self, v: usize) -> &[u16] {
        &self.bins[v * self.width..][..self.width]
    }
}
