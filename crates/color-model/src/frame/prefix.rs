use super::sums::{LANES, OUTLIERS, PixelSums, background_units, lanes_of};
use crate::{ColorModelError, YuvImage};

/// Widest row whose sums of products fit 32 bits: $`65535 \cdot 255^2 < 2^{32}`$, and whose background (at most 16.8 nats a pixel) does.
const MAX_WIDTH: usize = 3900;

/// An image as row prefix sums of ten numbers per pixel (one, $`c`$, $`c c^T`$), exact integers.
///
/// The sums over pixels `start..end` of a row are one subtraction, whatever the length. Twelve lanes of 32 bits a pixel, so that the
/// subtraction is three vector instructions.
///
/// ```
/// use wayfix_color_model::{PrefixSumImage, PixelSums, YuvImage, YuvStandard};
/// let rgb = [255, 255, 255, 0, 0, 0, 255, 255, 255]; // white, black, white
/// let image = YuvImage::from_rgb(3, 1, &rgb, YuvStandard::Bt601Full)?;
/// let frame = PrefixSumImage::new(&image)?;
/// let mut sums = PixelSums::default();
/// frame.add_run(0, 1, 3, &mut sums);
/// assert_eq!((sums.count(), sums.sum().x), (2, 255.0));
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PrefixSumImage {
    width: usize,
    height: usize,
    prefix: Vec<[u32; LANES]>,
}

impl PrefixSumImage {
    /// The sums of all pixels.
    ///
    /// # Errors
    /// Returns an error if the image is wider than 3900 pixels, the bound up to which 32 bits hold a row's sums.
    pub fn new(image: &YuvImage) -> Result<Self, ColorModelError> {
        Self::with(image, |_| Some(0))
    }

    /// Adds to the sums the background terms $`-\ln p_{bg}(c)`$ given by `nats`; pixels without a value count as outliers.
    ///
    /// Values are stored in units of 2⁻¹⁶ nats, between 0 and 16.8.
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_background(
        image: &YuvImage,
        mut nats: impl FnMut([u8; 3]) -> Option<f64>,
    ) -> Result<Self, ColorModelError> {
        Self::with(image, |pixel| nats(pixel).map(background_units))
    }

    fn with(
        image: &YuvImage,
        mut background: impl FnMut([u8; 3]) -> Option<u32>,
    ) -> Result<Self, ColorModelError> {
        let (width, height) = (image.width() as usize, image.height() as usize);
        if width > MAX_WIDTH {
            return Err(ColorModelError::TooWide { width, limit: MAX_WIDTH });
        }
        let mut prefix = Vec::with_capacity((width + 1) * height);
        for row in image.pixels().chunks_exact(width.max(1)) {
            let mut sums = [0_u32; LANES];
            prefix.push(sums);
            prefix.extend(row.iter().map(|&pixel| {
                match background(pixel) {
                    Some(units) => add(&mut sums, &lanes_of(pixel, units)),
                    None => sums[OUTLIERS] += 1,
                }
                sums
            }));
        }
        Ok(Self { width, height, prefix })
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }
    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Pixels in all.
    pub fn n_pixels(&self) -> usize {
        self.width * self.height
    }

    /// The sums from the start of a row up to each of its pixels; empty for a row outside the image.
    pub(crate) fn prefix_sums(&self, row: usize) -> &[[u32; LANES]] {
        let at = row * (self.width + 1);
        self.prefix.get(at..at + self.width + 1).unwrap_or(&[])
    }

    /// Adds pixels `start..end` of `row` to `sums`; pixels outside the image add nothing.
    #[inline]
    pub fn add_run(&self, row: usize, start: usize, end: usize, sums: &mut PixelSums) {
        let at = row * (self.width + 1);
        if start >= end || end > self.width {
            return;
        }
        if let (Some(before), Some(upto)) = (self.prefix.get(at + start), self.prefix.get(at + end)) {
            for lane in 0..LANES {
                sums.lanes[lane] += u64::from(upto[lane].wrapping_sub(before[lane]));
            }
        }
    }
}

fn add(sums: &mut [u32; LANES], lanes: &[u32; LANES]) {
    for (sum, lane) in sums.iter_mut().zip(lanes) {
        *sum += lane;
    }
}
