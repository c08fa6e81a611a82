use super::bit_mask::padding;
use crate::PixelMask;

/// Structuring element; a radius of 0 is a single pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StructuringElement {
    /// $`(2r + 1)^2`$ pixels.
    Square {
        /// $`r`$ in pixels.
        radius: usize,
    },
    /// $`2r + 1`$ pixels of a row and as many of a column, crossing in the middle.
    Cross {
        /// $`r`$ in pixels.
        radius: usize,
    },
}

/// Beyond the edges pixels are off for dilation and on for erosion, so that neither brings the edge into the mask and each is the other's
/// complement; closing only adds pixels and opening only takes some away.
///
/// ```
/// use wayfix_visual_tracking::{PixelMask, StructuringElement};
/// let square = StructuringElement::Square { radius: 1 };
/// let mask = PixelMask::from_fn(100, 9, |u, v| (60..69).contains(&u) && v != 4)?;
/// assert_eq!(mask.closed(square).area(), 9 * 9);
/// assert_eq!(mask.eroded(StructuringElement::Cross { radius: 2 }).area(), 5 * (2 + 2));
/// assert_eq!(mask.opened(StructuringElement::Square { radius: 2 }).area(), 9 * 8);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
impl PixelMask {
    /// Every pixel that the element reaches from one that is on.
    pub fn dilated(&self, element: StructuringElement) -> Self {
        match element {
            StructuringElement::Square { radius } => {
                self.spread_along_rows(radius).spread_along_columns(radius)
            }
            StructuringElement::Cross { radius } => {
                let mut words = self.spread_along_rows(radius).words().to_vec();
                let columns = self.spread_along_columns(radius);
                words.iter_mut().zip(columns.words()).for_each(|(a, b)| *a |= b);
                Self::from_words(self.width(), self.height(), words)
            }
        }
    }

    /// Every pixel round which the element fits.
    pub fn eroded(&self, element: StructuringElement) -> Self {
        self.not().dilated(element).not()
    }

    /// Opening: erosion, then dilation; it removes parts thinner than the element.
    pub fn opened(&self, element: StructuringElement) -> Self {
        self.eroded(element).dilated(element)
    }

    /// With gaps filled that are too thin for the element: dilated, then eroded.
    pub fn closed(&self, element: StructuringElement) -> Self {
        self.dilated(element).eroded(element)
    }

    /// The pixels that are on and share a side with one that is off or beyond the edge.
    pub fn boundary(&self) -> Self {
        let mut words = self.words().to_vec();
        let n = self.words_per_row();
        for (v, row) in words.chunks_exact_mut(n).enumerate() {
            let above = v.checked_sub(1).map(|v| self.row(v));
            let below = (v + 1 < self.height()).then(|| self.row(v + 1));
            let here = self.row(v);
            for (i, word) in row.iter_mut().enumerate() {
                let left = here[i] << 1 | i.checked_sub(1).map_or(0, |i| here[i] >> 63);
                let right = here[i] >> 1 | here.get(i + 1).map_or(0, |next| next << 63);
                *word &= !(left & right & above.map_or(0, |row| row[i]) & below.map_or(0, |row| row[i]));
            }
        }
        Self::from_words(self.width(), self.height(), words)
    }

    fn spread_along_rows(&self, radius: usize) -> Self {
        let mut words = self.words().to_vec();
        let padding = padding(self.width());
        for step in steps(radius.min(self.width()), 63) {
            for row in words.chunks_exact_mut(self.words_per_row()) {
                spread(row, step);
                if let Some(last) = row.last_mut() {
                    *last &= padding;
                }
            }
        }
        Self::from_words(self.width(), self.height(), words)
    }

    fn spread_along_columns(&self, radius: usize) -> Self {
        let mut words = self.words().to_vec();
        for step in steps(radius.min(self.height() - 1), usize::MAX) {
            let before = words.clone();
            let offset = step * self.words_per_row();
            words[offset..].iter_mut().zip(&before).for_each(|(word, above)| *word |= above);
            words.iter_mut().zip(&before[offset..]).for_each(|(word, below)| *word |= below);
        }
        Self::from_words(self.width(), self.height(), words)
    }
}

/// Shifts that sum to `radius`, each at most one more than the sum so far, so that the dilation has no gap, even at an image edge.
fn steps(radius: usize, longest: usize) -> impl Iterator<Item = usize> {
    let mut reached = 0;
    std::iter::from_fn(move || {
        let step = (reached + 1).min(radius - reached).min(longest);
        reached += step;
        (step > 0).then_some(step)
    })
}

/// Combines every column with those `step` before and after it, for `step` below 64.
fn spread(row: &mut [u64], step: usize) {
    let mut before = 0;
    for i in 0..row.len() {
        let here = row[i];
        let after = row.get(i + 1).copied().unwrap_or(0);
        row[i] |= here << step | before >> (64 - step) | here >> step | after << (64 - step);
        before = here;
    }
}
