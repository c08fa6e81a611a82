use super::ColorQuantizer;
use crate::tracking::mask::check_extent;
use crate::{CondensationError, View};

/// The colour bin of every pixel of a view, computed once for all hypotheses about it.
///
/// Pixels are counted from the corner of the view; [`View::corner`] says where that is in the picture.
///
/// ```
/// use wayfix_condensation::{BinImage, BinSet, ColorQuantizer, ColorSpace, Picture};
/// let picture = Picture::from_rgb(3, 1, vec![255, 0, 0, 0, 0, 255, 250, 9, 0])?;
/// let quantizer = ColorQuantizer::new(ColorSpace::Rgb, [8, 8, 8])?;
/// let image = BinImage::new(&quantizer, &picture.whole())?;
/// let reddish = BinSet::from_points(&quantizer, [[1.0, 0.0, 0.0]]);
/// let mask = image.segment(&reddish)?;
/// assert_eq!([0, 1, 2].map(|u| mask.get(u, 0)), [true, false, true]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BinImage {
    width: usize,
    n_bins: usize,
    bins: Vec<u16>,
}

impl BinImage {
    /// The bins of a view.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] when the view has more pixels than a [`BitMask`](crate::BitMask) may have.
    pub fn new(quantizer: &ColorQuantizer, view: &View<'_>) -> Result<Self, CondensationError> {
        check_extent(view.width(), view.height())?;
        let mut bins = vec![0; view.n_pixels()];
        for (row, pixels) in bins.chunks_exact_mut(view.width()).zip(view.rows()) {
            quantizer.bins_of_pixels(pixels, row);
        }
        Ok(Self { width: view.width(), n_bins: quantizer.n_bins(), bins })
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.bins.len() / self.width
    }

    /// How many bins there are to be in.
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

    /// One row of bins; the caller knows that there is one.
    pub(super) fn row(&self, v: usize) -> &[u16] {
        &self.bins[v * self.width..][..self.width]
    }
}
