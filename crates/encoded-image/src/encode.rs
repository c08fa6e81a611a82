use image::codecs::{jpeg::JpegEncoder, png::PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::{Anymap, EncodedImage, ImageError, ImageFileFormat};

impl EncodedImage {
    /// RGB pixels as JPEG of the given quality, 1 to 100; the same bytes on every machine.
    ///
    /// # Errors
    /// Returns an error if the pixels do not fill the image or there are none.
    pub fn jpeg(width: u32, height: u32, rgb: &[u8], quality: u8) -> Result<Self, ImageError> {
        check(width, height, 3, rgb)?;
        let mut bytes = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut bytes, quality.clamp(1, 100));
        encoder.write_image(rgb, width, height, ExtendedColorType::Rgb8).map_err(ImageError::Codec)?;
        Ok(Self::new(ImageFileFormat::Jpeg, bytes))
    }

    /// RGB pixels as PNG.
    ///
    /// # Errors
    /// Returns an error if the pixels do not fill the image or there are none.
    pub fn png_rgb(width: u32, height: u32, rgb: &[u8]) -> Result<Self, ImageError> {
        check(width, height, 3, rgb)?;
        png(width, height, rgb, ExtendedColorType::Rgb8)
    }

    /// Converts the image to a format that web pages show: uncompressed images become PNG, others are unchanged.
    /// # Errors
    /// Returns an error if an uncompressed image cannot be decoded.
    pub fn to_browser_format(&self) -> Result<Self, ImageError> {
        match (self.format, Anymap::of(&self.bytes)) {
            (ImageFileFormat::Pnm, Some(Anymap { channels: 1, .. })) => {
                let gray = self.decode_gray()?;
                Self::png_gray(gray.width, gray.height, &gray.pixels)
            }
            (ImageFileFormat::Pnm, _) => {
                let rgb = self.decode_rgb()?;
                Self::png_rgb(rgb.width, rgb.height, &rgb.pixels)
            }
            _ => Ok(self.clone()),
        }
    }

    /// Grey pixels, a byte each, as PNG.
    ///
    /// # Errors
    /// Returns an error if the pixels do not fill the image or there are none.
    pub fn png_gray(width: u32, height: u32, gray: &[u8]) -> Result<Self, ImageError> {
        check(width, height, 1, gray)?;
        png(width, height, gray, ExtendedColorType::L8)
    }
}

fn png(width: u32, height: u32, pixels: &[u8], color: ExtendedColorType) -> Result<EncodedImage, ImageError> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(pixels, width, height, color).map_err(ImageError::Codec)?;
    Ok(EncodedImage::new(ImageFileFormat::Png, bytes))
}

pub(crate) fn check(width: u32, height: u32, channels: u32, pixels: &[u8]) -> Result<(), ImageError> {
    if width == 0 || height == 0 {
        return Err(ImageError::Empty { width, height });
    }
    let expected = u64::from(width) * u64::from(height) * u64::from(channels);
    let got = pixels.len() as u64;
    if expected == got { Ok(()) } else { Err(ImageError::Size { width, height, channels, expected, got }) }
}
