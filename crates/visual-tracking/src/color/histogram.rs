use super::{ColorBinImage, ColorQuantizer};
use crate::error::{check_size, checked, probability};
use crate::{PixelMask, TrackingError};

/// Number of pixels per colour bin, as counts or as a blend of counts.
/// ```
/// use wayfix_visual_tracking::{ColorBinImage, ColorHistogram, ColorQuantizer, ColorSpace, RgbImage};
/// let quantizer = ColorQuantizer::new(ColorSpace::Rgb, [2, 2, 2])?;
/// let of = |bytes: Vec<u8>| -> Result<_, wayfix_visual_tracking::TrackingError> {
///     let picture = RgbImage::from_raw(4, 1, bytes).expect("3 bytes a pixel");
///     Ok(ColorHistogram::of_image(&ColorBinImage::new(&quantizer, &picture)?))
/// };
/// let mut model = of(vec![0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255])?;
/// let candidate = of(vec![0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255])?;
/// assert_eq!(candidate.intersection(&model)?, 0.5);
/// model.blend(&candidate, 0.25)?;
/// assert_eq!((model.counts()[0], model.counts()[7]), (2.5, 1.5));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ColorHistogram {
    // Whole numbers up to 2^53 are exact, so adding and removing pixels leaves no rounding error.
    counts: Vec<f64>,
}

impl ColorHistogram {
    /// Without pixels.
    pub fn empty(quantizer: &ColorQuantizer) -> Self {
        Self::of_size(quantizer.n_bins())
    }

    /// Of all pixels.
    pub fn of_image(image: &ColorBinImage) -> Self {
        Self::counted(image.n_bins(), [image.bins()])
    }

    /// Of the pixels that are on in a mask.
    ///
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if image and mask differ in size.
    pub fn of_mask(image: &ColorBinImage, mask: &PixelMask) -> Result<Self, TrackingError> {
        mask.check_size((image.width(), image.height()))?;
        Ok(Self::counted(image.n_bins(), mask.runs().map(|(v, run)| &image.row(v)[run])))
    }

    /// From given counts, one a bin.
    ///
    /// # Errors
    /// Returns [`TrackingError::Dimension`] and, for a count that is negative or not finite, [`TrackingError::Parameter`].
    pub fn from_counts(quantizer: &ColorQuantizer, counts: Vec<f64>) -> Result<Self, TrackingError> {
        check_size("counts", quantizer.n_bins(), counts.len())?;
        for &count in &counts {
            checked("count of a bin", count, count.is_finite() && count >= 0.0, "finite and not negative")?;
        }
        Ok(Self { counts })
    }

    /// The count of each bin.
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    /// The sum of all counts.
    pub fn total(&self) -> f64 {
        self.counts.iter().sum()
    }

    /// Share of this histogram, the candidate's, that is in the model's: $`\sum_i \min(C_i, M_i) / \sum_i C_i`$, from 0 to 1; 0 without
    /// pixels. [Andrade-Cetto 2005, Eq. 28; Swain & Ballard 1991]
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if they differ in the number of bins.
    pub fn intersection(&self, model: &Self) -> Result<f64, TrackingError> {
        check_size("histogram", self.counts.len(), model.counts.len())?;
        let (mut shared, mut total) = ([0.0; LANES], [0.0; LANES]);
        let (own, theirs) = (self.counts.chunks(LANES), model.counts.chunks(LANES));
        for (own, theirs) in own.zip(theirs) {
            for (k, (&count, &other)) in own.iter().zip(theirs).enumerate() {
                shared[k] += if count < other { count } else { other };
                total[k] += count;
            }
        }
        let total: f64 = total.iter().sum();
        Ok(if total > 0.0 { shared.iter().sum::<f64>() / total } else { 0.0 })
    }

    /// Adapts a model to a candidate: $`M ← (1 - a) M + a C`$. [Andrade-Cetto 2005, Eq. 29]
    ///
    /// # Errors
    /// Returns [`TrackingError::Dimension`] as [`intersection`](Self::intersection), or [`TrackingError::Parameter`] if `rate` is not between 0
    /// and 1.
    pub fn blend(&mut self, candidate: &Self, rate: f64) -> Result<(), TrackingError> {
        check_size("histogram", self.counts.len(), candidate.counts.len())?;
        let rate = probability("rate of adaptation", rate)?;
        for (count, other) in self.counts.iter_mut().zip(&candidate.counts) {
            *count = (1.0 - rate) * *count + rate * other;
        }
        Ok(())
    }

    /// The histogram scaled to another total, such as 1 or the pixel count of a candidate; unchanged without pixels.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if `total` is not finite and positive.
    pub fn scaled_to(&self, total: f64) -> Result<Self, TrackingError> {
        checked("total of a histogram", total, total.is_finite() && total > 0.0, "finite and positive")?;
        let factor = match self.total() {
            0.0 => 1.0,
            own => total / own,
        };
        Ok(Self { counts: self.counts.iter().map(|count| count * factor).collect() })
    }

    /// Counts pixels by their bins.
    pub(super) fn add(&mut self, bins: &[u16]) {
        bins.iter().for_each(|&bin| self.counts[usize::from(bin)] += 1.0);
    }

    /// Removes pixels that were counted.
    pub(super) fn remove(&mut self, bins: &[u16]) {
        bins.iter().for_each(|&bin| self.counts[usize::from(bin)] -= 1.0);
    }

    /// Counts parts of rows in integers: where many pixels in a row share a bin, chained float sums would take ten times as long.
    pub(super) fn counted<'a>(n_bins: usize, pieces: impl IntoIterator<Item = &'a [u16]>) -> Self {
        let mut counts = vec![0_u32; n_bins];
        for piece in pieces {
            piece.iter().for_each(|&bin| counts[usize::from(bin)] += 1);
        }
        Self { counts: counts.into_iter().map(f64::from).collect() }
    }

    fn of_size(n_bins: usize) -> Self {
        Self { counts: vec![0.0; n_bins] }
    }
}

/// Sums side by side, which the compiler may keep in vectors; the order of summation is fixed all the same.
const LANES: usize = 8;
