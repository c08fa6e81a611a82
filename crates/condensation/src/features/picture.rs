use crate::CondensationError;
use crate::error::check_size;
use crate::features::View;

/// Shares of red, green and blue in the grey value, of 65536. [ITU-R BT.601]
const LUMA: [u32; 3] = [19595, 38470, 7471];

/// A picture of 8-bit red, green and blue, and the grey values that go with it.
///
/// Row by row from the top left, no padding.
///
/// ```
/// use wayfix_condensation::Picture;
/// let picture = Picture::from_rgb(2, 1, vec![255, 255, 255, 0, 0, 0])?;
/// assert_eq!(picture.grey(), &[255, 0]);
/// assert!(Picture::from_rgb(2, 1, vec![0; 5]).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<[u8; 3]>,
    grey: Vec<u8>,
}

impl Picture {
    /// From `3 · width · height` bytes.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] without pixels, [`CondensationError::Dimension`] when the bytes are not that many.
    pub fn from_rgb(width: usize, height: usize, bytes: Vec<u8>) -> Result<Self, CondensationError> {
        let n_bytes = width.checked_mul(height).and_then(|n| n.checked_mul(3)).filter(|&n| n > 0);
        let n_bytes =
            n_bytes.ok_or(CondensationError::Extent { what: "picture", size: vec![width, height] })?;
        check_size("picture", n_bytes, bytes.len())?;
        let rgb = bytes.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Ok(Self::from_pixels(width, height, rgb))
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.rgb
    }

    /// The grey value of every pixel: $`0.299 R + 0.587 G + 0.114 B`$, rounded.
    pub fn grey(&self) -> &[u8] {
        &self.grey
    }

    /// The picture as one view.
    pub fn whole(&self) -> View<'_> {
        View::inside(self, (0, 0), (self.width, self.height))
    }

    /// The picture with every channel sent through its own table.
    pub fn mapped(&self, tables: &[[u8; 256]; 3]) -> Self {
        let rgb = self.rgb.iter().map(|pixel| [0, 1, 2].map(|c| tables[c][usize::from(pixel[c])])).collect();
        Self::from_pixels(self.width, self.height, rgb)
    }

    /// What the camera sees moved right by `dx` and down by `dy` pixels: `(x, y)` shows what was at `(x + dx, y + dy)`. Beyond the edge
    /// the last pixel repeats.
    pub fn shifted(&self, dx: i32, dy: i32) -> Self {
        let at = |i: usize, by: i32, len: usize| i.saturating_add_signed(by as isize).min(len - 1);
        let row = |y: usize| {
            let start = at(y, dy, self.height) * self.width;
            (0..self.width).map(move |x| self.rgb[start + at(x, dx, self.width)])
        };
        Self::from_pixels(self.width, self.height, (0..self.height).flat_map(row).collect())
    }

    /// The part of the picture that starts at `corner`, if it lies inside.
    ///
    /// # Errors
    /// [`CondensationError::SceneSmallerThanView`] when it does not.
    pub fn view(&self, corner: (usize, usize), size: (usize, usize)) -> Result<View<'_>, CondensationError> {
        let fits =
            |from: usize, n: usize, len: usize| n > 0 && from.checked_add(n).is_some_and(|end| end <= len);
        if fits(corner.0, size.0, self.width) && fits(corner.1, size.1, self.height) {
            return Ok(View::inside(self, corner, size));
        }
        Err(CondensationError::SceneSmallerThanView { scene: (self.width, self.height), view: size })
    }

    fn from_pixels(width: usize, height: usize, rgb: Vec<[u8; 3]>) -> Self {
        let luma = |pixel: &[u8; 3]| {
            let sum: u32 = pixel.iter().zip(LUMA).map(|(&value, share)| u32::from(value) * share).sum();
            ((sum + 32768) >> 16) as u8
        };
        let grey = rgb.iter().map(luma).collect();
        Self { width, height, rgb, grey }
    }
}
