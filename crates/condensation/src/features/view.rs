use image::{GrayImage, RgbImage};

use crate::CondensationError;
use crate::features::picture::{grey, rgb_pixels, size};

/// A rectangle of a picture: the view of the camera in one state.
///
/// ```
/// use wayfix_condensation::{RgbImage, View};
/// let picture = RgbImage::from_raw(2, 1, vec![255, 255, 255, 0, 0, 0]).expect("3 bytes a pixel");
/// assert_eq!(View::whole(&picture)?.grey().as_raw(), &[255, 0]);
/// assert_eq!(View::new(&picture, (1, 0), (1, 1))?.rows().next(), Some(&[[0; 3]][..]));
/// assert!(View::new(&picture, (1, 0), (2, 1)).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    picture: &'a RgbImage,
    corner: (usize, usize),
    size: (usize, usize),
}

impl<'a> View<'a> {
    /// The part of a picture that starts at `corner`, if it lies inside.
    ///
    /// # Errors
    /// [`CondensationError::SceneSmallerThanView`] when it does not, or has no pixels.
    pub fn new(
        picture: &'a RgbImage,
        corner: (usize, usize),
        view: (usize, usize),
    ) -> Result<Self, CondensationError> {
        let fits =
            |from: usize, n: usize, len: usize| n > 0 && from.checked_add(n).is_some_and(|end| end <= len);
        let scene = size(picture);
        if fits(corner.0, view.0, scene.0) && fits(corner.1, view.1, scene.1) {
            return Ok(Self::inside(picture, corner, view));
        }
        Err(CondensationError::SceneSmallerThanView { scene, view })
    }

    /// A picture as one view.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] when the picture has no pixels.
    pub fn whole(picture: &'a RgbImage) -> Result<Self, CondensationError> {
        let (width, height) = size(picture);
        if width == 0 || height == 0 {
            return Err(CondensationError::Extent { what: "picture", size: vec![width, height] });
        }
        Ok(Self::inside(picture, (0, 0), (width, height)))
    }

    /// The caller guarantees that the rectangle lies inside and has pixels.
    pub(crate) fn inside(picture: &'a RgbImage, corner: (usize, usize), size: (usize, usize)) -> Self {
        Self { picture, corner, size }
    }

    /// Column and row of the top left pixel in the picture.
    pub fn corner(&self) -> (usize, usize) {
        self.corner
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.size.0
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.size.1
    }

    /// How many pixels it has.
    pub fn n_pixels(&self) -> usize {
        self.size.0 * self.size.1
    }

    /// Rows of red, green and blue, from the top.
    pub fn rows(&self) -> impl Iterator<Item = &'a [[u8; 3]]> {
        let ((x, y), (width, height)) = (self.corner, self.size);
        let lines = rgb_pixels(self.picture).chunks_exact(self.picture.width() as usize);
        lines.skip(y).take(height).map(move |row| &row[x..x + width])
    }

    /// The grey value of every pixel, as of [`grey`](crate::grey()).
    pub fn grey(&self) -> GrayImage {
        grey(&self.to_image())
    }

    /// The pixels as a picture of their own.
    pub fn to_image(&self) -> RgbImage {
        let bytes = self.rows().flatten().flatten().copied().collect();
        RgbImage::from_raw(self.size.0 as u32, self.size.1 as u32, bytes).expect("invariant: 3 bytes a pixel")
    }
}
