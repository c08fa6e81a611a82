use std::{fs, path::Path};

use wayfix_sensor_log::EncodedImage;
use wayfix_visual_tracking::{BoundingBox, PixelMask, RgbImage, TrackingError};

use super::TrackSystemError;

/// Position of the target in the first image.
///
/// ```
/// use wayfix_systems::track::InitialTargetRegion;
/// use wayfix_visual_tracking::{PixelMask, BoundingBox};
/// let mask = PixelMask::from_fn(20, 10, |u, v| (4..9).contains(&u) && v > 6)?;
/// assert_eq!(InitialTargetRegion::Mask(mask).bounding_box()?, BoundingBox::from_corner(4.0, 7.0, 5.0, 3.0)?);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub enum InitialTargetRegion {
    /// A bounding box.
    Box(BoundingBox),
    /// A mask of the target's pixels.
    Mask(PixelMask),
}

impl InitialTargetRegion {
    /// Reads a mask from an image file: every pixel that is not black belongs to the target.
    ///
    /// # Errors
    /// Returns [`TrackSystemError::Read`], or [`TrackSystemError::NotAMask`] if the file is no image or is too large.
    pub fn read_mask(path: &Path) -> Result<Self, TrackSystemError> {
        let bytes =
            fs::read(path).map_err(|source| TrackSystemError::Read { path: path.to_owned(), source })?;
        let wrong = |reason: String| TrackSystemError::NotAMask { path: path.to_owned(), reason };
        let image = EncodedImage::from_bytes(bytes).ok_or_else(|| wrong("it is no picture".to_owned()))?;
        let decoded = image.decode_rgb().map_err(|error| wrong(error.to_string()))?;
        let (width, height) = (decoded.width as usize, decoded.height as usize);
        let is_on = |u: usize, v: usize| decoded.pixels[3 * (v * width + u)..][..3] != [0; 3];
        PixelMask::from_fn(width, height, is_on).map(Self::Mask).map_err(|error| wrong(error.to_string()))
    }

    /// The bounding box of the target.
    ///
    /// # Errors
    /// Returns an error if a mask is empty.
    pub fn bounding_box(&self) -> Result<BoundingBox, TrackingError> {
        match self {
            Self::Box(bounds) => Ok(*bounds),
            Self::Mask(mask) => {
                let rect = mask.bounding_rect().ok_or(TrackingError::Empty { what: "target in the mask" })?;
                rect.to_box()
            }
        }
    }

    /// The bounding box of the target in an image.
    ///
    /// # Errors
    /// Returns an error if a mask is empty or differs from the image in size.
    pub(super) fn box_in(&self, picture: &RgbImage) -> Result<BoundingBox, TrackingError> {
        if let Self::Mask(mask) = self {
            let sizes = [
                ("width of the mask", picture.width() as usize, mask.width()),
                ("height of the mask", picture.height() as usize, mask.height()),
            ];
            for (what, expected, got) in sizes {
                if expected != got {
                    return Err(TrackingError::Dimension { what, expected, got });
                }
            }
        }
        self.bounding_box()
    }

    /// Short description.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Box(bounds) => {
                let [x, y] = bounds.corner();
                format!("box {x},{y},{},{}", bounds.width(), bounds.height())
            }
            Self::Mask(mask) => format!("mask of {} pixels", mask.area()),
        }
    }
}
