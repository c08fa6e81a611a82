//! From colours to pixels: which pixels are in a set of bins.

use super::{ColorBinImage, ColorBinSet};
use crate::error::check_size;
use crate::{PixelMask, TrackingError};

impl ColorBinImage {
    /// The pixels whose bin is on: $`S(u, v) = 1`$ where $`H(r, g, b) > 0`$. [Andrade-Cetto 2005, Sec. 3.3]
    ///
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if the set has another number of bins.
    pub fn segment(&self, set: &ColorBinSet) -> Result<PixelMask, TrackingError> {
        check_size("set of bins", self.n_bins(), set.n_bins())?;
        // A byte per bin allows a faster look-up than a bit.
        let mut on = vec![0_u8; self.n_bins()];
        set.iter().for_each(|bin| on[usize::from(bin)] = 1);
        let word = |bins: &[u16]| {
            let bits = bins.iter().enumerate().map(|(k, &bin)| u64::from(on[usize::from(bin)]) << k);
            bits.fold(0, |word, bit| word | bit)
        };
        let words = self.rows().flat_map(|row| row.chunks(64).map(word)).collect();
        Ok(PixelMask::from_words(self.width(), self.height(), words))
    }

    /// [`segment`](Self::segment) for many sets at once, in one pass over the image for every 64 of them.
    ///
    /// One look-up gives the membership of a pixel's bin in 64 sets. 64 pixels give a square of bits; its transpose holds one word of every mask.
    /// # Errors
    /// Returns the errors of [`segment`](Self::segment).
    pub fn segment_all(&self, sets: &[ColorBinSet]) -> Result<Vec<PixelMask>, TrackingError> {
        for set in sets {
            check_size("set of bins", self.n_bins(), set.n_bins())?;
        }
        let mut masks = Vec::with_capacity(sets.len());
        let n_words = self.width().div_ceil(64) * self.height();
        for group in sets.chunks(64) {
            let mut words = vec![vec![0; n_words]; group.len()];
            let members = members(group, self.n_bins());
            for (i, bins) in self.rows().flat_map(|row| row.chunks(64)).enumerate() {
                let mut square = [0; 64];
                for (line, &bin) in square.iter_mut().zip(bins) {
                    *line = members[usize::from(bin)];
                }
                if square.iter().any(|&line| line != 0) {
                    transpose(&mut square);
                    words.iter_mut().zip(square).for_each(|(mask, word)| mask[i] = word);
                }
            }
            masks.extend(
                words.into_iter().map(|mask| PixelMask::from_words(self.width(), self.height(), mask)),
            );
        }
        Ok(masks)
    }
}

/// For every bin, which of up to 64 sets have it.
fn members(sets: &[ColorBinSet], n_bins: usize) -> Vec<u64> {
    let mut members = vec![0; n_bins];
    for (k, set) in sets.iter().enumerate() {
        set.iter().for_each(|bin| members[usize::from(bin)] |= 1 << k);
    }
    members
}

/// Swaps bit `i` of word `k` with bit `k` of word `i`, by recursive exchange of half blocks across the diagonal.
fn transpose(square: &mut [u64; 64]) {
    let mut width = 32;
    let mut low = u64::MAX >> 32;
    while width > 0 {
        for block in square.chunks_exact_mut(2 * width) {
            let (upper, lower) = block.split_at_mut(width);
            for (a, b) in upper.iter_mut().zip(lower) {
                let swapped = (*a >> width ^ *b) & low;
                *a ^= swapped << width;
                *b ^= swapped;
            }
        }
        width /= 2;
        low ^= low << width;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transposed_square_is_turned_over_its_diagonal() {
        let square: [u64; 64] =
            std::array::from_fn(|k| (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(k as u32));
        let mut turned = square;
        transpose(&mut turned);
        for (k, line) in square.iter().enumerate() {
            for (i, column) in turned.iter().enumerate() {
                assert_eq!(line >> i & 1, column >> k & 1);
            }
        }
    }
}
