use super::{YuvStandard, standard::convert};
use crate::ColorModelError;

/// An image of YUV pixels, row by row from the upper left.
///
/// ```
/// use wayfix_color_model::{YuvImage, YuvStandard};
/// let image = YuvImage::from_rgb(2, 1, &[0, 0, 0, 255, 255, 255], YuvStandard::Bt601Full)?;
/// assert_eq!(image.pixels(), [[0, 128, 128], [255, 128, 128]]);
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct YuvImage {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

impl YuvImage {
    /// An image of YUV pixels.
    ///
    /// # Errors
    /// Returns an error if the pixels do not fill the image, or there are none.
    pub fn new(width: u32, height: u32, pixels: Vec<[u8; 3]>) -> Result<Self, ColorModelError> {
        let got = pixels.len() * 3;
        check(width, height, got)?;
        Ok(Self { width, height, pixels })
    }

    /// Converts RGB bytes.
    ///
    /// # Errors
    /// Returns an error if the bytes do not fill the image, or there are none.
    pub fn from_rgb(
        width: u32,
        height: u32,
        rgb: &[u8],
        standard: YuvStandard,
    ) -> Result<Self, ColorModelError> {
        check(width, height, rgb.len())?;
        let weights = standard.weights();
        let (pixels, _) = rgb.as_chunks::<3>();
        Ok(Self { width, height, pixels: pixels.iter().map(|rgb| convert(&weights, *rgb)).collect() })
    }

    /// Averages squares of `by` × `by` pixels; incomplete squares at the right and at the bottom are dropped.
    /// # Errors
    /// Returns an error if no square fits into the image, or `by` is 0.
    ///
    /// ```
    /// # use wayfix_color_model::YuvImage;
    /// let image = YuvImage::new(3, 2, vec![[10, 0, 0], [20, 0, 0], [99, 0, 0], [30, 0, 0], [40, 0, 0], [99, 0, 0]])?;
    /// assert_eq!(image.shrunk(2)?.pixels(), [[25, 0, 0]]);
    /// # Ok::<(), wayfix_color_model::ColorModelError>(())
    /// ```
    pub fn shrunk(&self, by: u32) -> Result<Self, ColorModelError> {
        let [width, height] = [self.width, self.height].map(|side| side.checked_div(by).unwrap_or(0));
        let by = by as usize;
        let n = (by * by) as u64;
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for rows in self.pixels.chunks_exact((self.width as usize * by).max(1)) {
            for column in 0..width as usize {
                let mut sum = [n / 2; 3];
                for row in rows.chunks_exact(self.width as usize) {
                    for pixel in &row[column * by..][..by] {
                        (0..3).for_each(|channel| sum[channel] += u64::from(pixel[channel]));
                    }
                }
                pixels.push(sum.map(|sum| (sum / n) as u8));
            }
        }
        Self::new(width, height, pixels)
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// `[Y, U, V]` of every pixel.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Mean of Y; 0 of an image without pixels.
    pub fn brightness(&self) -> f64 {
        let sum: u64 = self.pixels.iter().map(|pixel| u64::from(pixel[0])).sum();
        sum as f64 / self.pixels.len().max(1) as f64
    }
}

fn check(width: u32, height: u32, got: usize) -> Result<(), ColorModelError> {
    let (width, height) = (width as usize, height as usize);
    let expected = width.checked_mul(height).and_then(|n| n.checked_mul(3)).unwrap_or(0);
    if expected == got && got > 0 {
        Ok(())
    } else {
        Err(ColorModelError::ImageSize { width, height, expected, got })
    }
}
