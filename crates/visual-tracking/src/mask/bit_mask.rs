use std::ops::Range;

use super::runs::runs;
use crate::TrackingError;
use crate::error::check_size;

/// A set of pixels, 64 to a word.
///
/// Rows are padded to whole words with zeros; bit $`k`$ of word $`i`$ of a row is the pixel in column $`64 i + k`$.
///
/// ```
/// use wayfix_visual_tracking::PixelMask;
/// let mask = PixelMask::from_fn(100, 3, |u, v| u > 60 && v == 1)?;
/// assert!(mask.get(70, 1) && !mask.get(70, 2) && !mask.get(100, 1));
/// let border = mask.not().and(&PixelMask::full(100, 3)?)?;
/// assert_eq!(border.area() + mask.area(), 300);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelMask {
    width: usize,
    height: usize,
    words: Vec<u64>,
}

/// More pixels than any camera has, few enough to allocate on a wrong number without harm.
const MAX_PIXELS: usize = 1 << 28;

impl PixelMask {
    /// No pixel is on.
    ///
    /// # Errors
    /// Returns [`TrackingError::Extent`] if a side is zero, or there are more than $`2^{28}`$ pixels.
    pub fn empty(width: usize, height: usize) -> Result<Self, TrackingError> {
        check_extent(width, height)?;
        Ok(Self { width, height, words: vec![0; width.div_ceil(64) * height] })
    }

    /// Every pixel is on.
    ///
    /// # Errors
    /// Returns the errors of [`empty`](Self::empty).
    pub fn full(width: usize, height: usize) -> Result<Self, TrackingError> {
        Ok(Self::empty(width, height)?.not())
    }

    /// The pixels of column `u` and row `v` for which `on(u, v)` is true.
    ///
    /// # Errors
    /// Returns the errors of [`empty`](Self::empty).
    pub fn from_fn(
        width: usize,
        height: usize,
        mut on: impl FnMut(usize, usize) -> bool,
    ) -> Result<Self, TrackingError> {
        let mut mask = Self::empty(width, height)?;
        for v in 0..height {
            for u in (0..width).filter(|&u| on(u, v)) {
                mask.row_mut(v)[u / 64] |= 1 << (u % 64);
            }
        }
        Ok(mask)
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Width and height.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Whether the pixel in column `u` and row `v` is on; none is beyond the edges.
    pub fn get(&self, u: usize, v: usize) -> bool {
        u < self.width && v < self.height && self.row(v)[u / 64] >> (u % 64) & 1 == 1
    }

    /// Switches a pixel on or off.
    ///
    /// # Errors
    /// Returns [`TrackingError::Outside`] beyond the edges.
    pub fn set(&mut self, u: usize, v: usize, on: bool) -> Result<(), TrackingError> {
        if u >= self.width || v >= self.height {
            return Err(TrackingError::Outside { pixel: (u, v), size: (self.width, self.height) });
        }
        let word = &mut self.row_mut(v)[u / 64];
        *word = *word & !(1 << (u % 64)) | u64::from(on) << (u % 64);
        Ok(())
    }

    /// Intersection of the masks.
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if the sizes differ.
    pub fn and(&self, other: &Self) -> Result<Self, TrackingError> {
        self.zip(other, |a, b| a & b)
    }

    /// Union of the masks.
    /// # Errors
    /// Returns the errors of [`and`](Self::and).
    pub fn or(&self, other: &Self) -> Result<Self, TrackingError> {
        self.zip(other, |a, b| a | b)
    }

    /// Difference: the pixels on here and off there.
    /// # Errors
    /// Returns the errors of [`and`](Self::and).
    pub fn and_not(&self, other: &Self) -> Result<Self, TrackingError> {
        self.zip(other, |a, b| a & !b)
    }

    /// The pixels that are off.
    pub fn not(&self) -> Self {
        let mut words: Vec<u64> = self.words.iter().map(|word| !word).collect();
        let padding = padding(self.width);
        words.chunks_exact_mut(self.words_per_row()).for_each(|row| {
            if let Some(last) = row.last_mut() {
                *last &= padding;
            }
        });
        Self { words, ..*self }
    }

    /// Rows and the columns in them that are on without a gap, from the top left.
    pub fn runs(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        self.rows().enumerate().flat_map(|(v, row)| runs(row).map(move |run| (v, run)))
    }

    /// Builds a mask from rows of words; the caller ensures their number and zeros in the padding.
    pub(crate) fn from_words(width: usize, height: usize, words: Vec<u64>) -> Self {
        debug_assert_eq!(words.len(), width.div_ceil(64) * height);
        Self { width, height, words }
    }

    pub(super) fn words_per_row(&self) -> usize {
        self.width.div_ceil(64)
    }

    pub(super) fn words(&self) -> &[u64] {
        &self.words
    }

    pub(super) fn row(&self, v: usize) -> &[u64] {
        &self.words[v * self.words_per_row()..][..self.words_per_row()]
    }

    pub(super) fn row_mut(&mut self, v: usize) -> &mut [u64] {
        let n = self.words_per_row();
        &mut self.words[v * n..][..n]
    }

    pub(super) fn rows(&self) -> impl DoubleEndedIterator<Item = &[u64]> {
        self.words.chunks_exact(self.words_per_row())
    }

    pub(crate) fn check_size(&self, (width, height): (usize, usize)) -> Result<(), TrackingError> {
        check_size("width of a mask", width, self.width)?;
        check_size("height of a mask", height, self.height)
    }

    fn zip(&self, other: &Self, op: impl Fn(u64, u64) -> u64) -> Result<Self, TrackingError> {
        other.check_size(self.size())?;
        let words = self.words.iter().zip(&other.words).map(|(&a, &b)| op(a, b)).collect();
        Ok(Self { words, ..*self })
    }
}

/// Whether a mask may have that size.
pub(crate) fn check_extent(width: usize, height: usize) -> Result<(), TrackingError> {
    // A row takes a whole word however narrow it is.
    let padded = width.checked_next_multiple_of(64).and_then(|width| width.checked_mul(height));
    match padded {
        Some(1..=MAX_PIXELS) => Ok(()),
        _ => Err(TrackingError::Extent { what: "mask", size: vec![width, height] }),
    }
}

/// The bits of the last word of a row that are pixels.
pub(super) fn padding(width: usize) -> u64 {
    u64::MAX >> (width.next_multiple_of(64) - width)
}
