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
}
