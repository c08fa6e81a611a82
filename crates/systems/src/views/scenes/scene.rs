use std::{fs, path::Path};

use wayfix_condensation::RgbImage;
use wayfix_sensor_log::EncodedImage;

use super::super::ViewsError;

/// An image from a file, and the changes made on conversion to eight-bit RGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneImage {
    /// The picture.
    pub picture: RgbImage,
    /// Conversions that changed the image, a phrase each.
    pub remarks: Vec<&'static str>,
}

/// Reads a JPEG or PNG file. Grey becomes colour, deeper channels are rounded to eight bits and transparency is dropped; the remarks list it.
///
/// # Errors
/// Returns [`ViewsError::Read`], [`ViewsError::NotAPicture`], [`ViewsError::Image`].
pub fn read_scene(path: &Path) -> Result<SceneImage, ViewsError> {
    let bytes = fs::read(path).map_err(|source| ViewsError::Read { path: path.into(), source })?;
    let image =
        EncodedImage::from_bytes(bytes).ok_or_else(|| ViewsError::NotAPicture { path: path.into() })?;
    let damaged = |source| ViewsError::Image { path: path.into(), source };
    let layout = image.layout().map_err(damaged)?;
    let decoded = image.decode_rgb().map_err(damaged)?;
    let remarks = [
        (layout.channels <= 2, "is grey: red, green and blue are the same"),
        (layout.bits_per_channel > 8, "has more than eight bits a channel: rounded to eight"),
        (layout.has_alpha(), "has transparency: left out"),
    ];
    Ok(SceneImage {
        picture: RgbImage::from_raw(decoded.width, decoded.height, decoded.pixels)
            .expect("invariant: 3 bytes a pixel"),
        remarks: remarks.into_iter().filter_map(|(applies, remark)| applies.then_some(remark)).collect(),
    })
}
