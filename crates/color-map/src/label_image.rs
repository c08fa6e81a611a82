use crate::{ColorId, PixelSpan, RenderError};

/// A map colour, or none, for every pixel.
///
/// As bytes, for a grey image file: 0 means no map colour, `k + 1` means `ColorId(k)`.
/// ```
/// use wayfix_color_map::{ColorId, LabelImage};
///
/// let labels = LabelImage::from_codes(2, 2, &[0, 1, 3, 3])?;
/// assert_eq!(labels.get(1, 0), Some(ColorId(0)));
/// assert_eq!(labels.count(ColorId(2)), 2);
/// # Ok::<(), wayfix_color_map::RenderError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelImage {
    width: u32,
    height: u32,
    pixels: Vec<Option<ColorId>>,
}

impl LabelImage {
    /// An image without a label.
    pub(crate) fn empty(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![None; width as usize * height as usize] }
    }

    /// Labels from bytes, row by row from the top.
    ///
    /// # Errors
    /// Returns [`RenderError::Size`] if their number is not `width * height`.
    pub fn from_codes(width: u32, height: u32, codes: &[u8]) -> Result<Self, RenderError> {
        let expected = width as usize * height as usize;
        if codes.len() != expected {
            return Err(RenderError::Size { width, height, expected, got: codes.len() });
        }
        Ok(Self {
            width,
            height,
            pixels: codes.iter().map(|&code| code.checked_sub(1).map(ColorId)).collect(),
        })
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The label of a pixel; none beside the image.
    pub fn get(&self, column: u32, row: u32) -> Option<ColorId> {
        if column >= self.width {
            return None;
        }
        *self.pixels.get(row as usize * self.width as usize + column as usize)?
    }

    /// All labels, row by row from the top.
    pub fn pixels(&self) -> &[Option<ColorId>] {
        &self.pixels
    }

    /// Number of pixels of this colour.
    pub fn count(&self, color: ColorId) -> usize {
        self.pixels.iter().filter(|&&pixel| pixel == Some(color)).count()
    }

    pub(crate) fn paint(&mut self, span: PixelSpan) {
        let row = usize::from(span.row) * self.width as usize;
        self.pixels[row + usize::from(span.start)..row + usize::from(span.end)].fill(Some(span.color));
    }
}
