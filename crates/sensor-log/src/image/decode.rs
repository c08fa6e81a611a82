use std::io::Cursor;

use image::{DynamicImage, ImageReader, Limits};

use super::{DecodedImage, EncodedImage, ImageError, ImageFormat};

/// No robot's camera has more pixels on a side; a damaged or hostile header must not fill the memory.
const MAX_SIDE: u32 = 16_384;
/// Bytes that a decoder may allocate: 64 million pixels of four bytes.
const MAX_BYTES: u64 = 256 << 20;

impl EncodedImage {
    /// The image in colour: grey becomes colour, deeper channels lose their low bits, transparency is dropped.
    ///
    /// # Errors
    /// When the bytes are damaged or cut short, not of the format that they should have, or claim more than 16 384 pixels on a side.
    pub fn decode_rgb(&self) -> Result<DecodedImage, ImageError> {
        let image = self.decode()?.into_rgb8();
        Ok(DecodedImage { width: image.width(), height: image.height(), pixels: image.into_raw() })
    }

    /// The image in grey: for a grey image its own bytes, else luma of its colours.
    ///
    /// # Errors
    /// As [`decode_rgb`](Self::decode_rgb).
    pub fn decode_gray(&self) -> Result<DecodedImage, ImageError> {
        let image = self.decode()?.into_luma8();
        Ok(DecodedImage { width: image.width(), height: image.height(), pixels: image.into_raw() })
    }

    fn decode(&self) -> Result<DynamicImage, ImageError> {
        let format = match self.format {
            ImageFormat::Jpeg => image::ImageFormat::Jpeg,
            ImageFormat::Png => image::ImageFormat::Png,
        };
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIDE), Some(MAX_SIDE));
        limits.max_alloc = Some(MAX_BYTES);
        let mut reader = ImageReader::with_format(Cursor::new(&*self.bytes), format);
        reader.limits(limits);
        reader.decode().map_err(ImageError::Codec)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32) -> Vec<u8> {
        (0..width * height).flat_map(|k| [k as u8, (k / 2) as u8, 128]).collect()
    }

    #[test]
    fn png_keeps_every_bit_and_jpeg_nearly() {
        let rgb = ramp(16, 8);
        let png = EncodedImage::png_rgb(16, 8, &rgb).unwrap().decode_rgb().unwrap();
        assert_eq!((png.width, png.height, png.pixels), (16, 8, rgb.clone()));
        let jpeg = EncodedImage::jpeg(16, 8, &rgb, 95).unwrap().decode_rgb().unwrap();
        let worst = jpeg.pixels.iter().zip(&rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(worst <= 24, "{worst}"); // the ramp jumps by 255 where it wraps
    }

    #[test]
    fn what_is_cut_short_is_an_error_or_an_image_of_the_right_size_and_never_a_panic() {
        let whole = EncodedImage::jpeg(32, 16, &ramp(32, 16), 90).unwrap();
        for n in 0..whole.bytes.len() {
            let cut = EncodedImage::new(ImageFormat::Jpeg, &whole.bytes[..n]);
            if let Ok(image) = cut.decode_rgb() {
                assert_eq!(image.pixels.len(), 32 * 16 * 3);
            }
        }
        assert!(EncodedImage::new(ImageFormat::Png, &whole.bytes[..]).decode_rgb().is_err());
    }

    #[test]
    fn a_header_that_claims_too_much_is_refused_before_anything_is_allocated() {
        let mut bytes = EncodedImage::png_gray(4, 4, &[7; 16]).unwrap().bytes.to_vec();
        bytes[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]); // 65 536 x 65 536
        assert!(EncodedImage::new(ImageFormat::Png, bytes).decode_gray().is_err());
    }

    #[test]
    fn pixels_that_do_not_fill_the_image_are_refused() {
        let error = EncodedImage::png_rgb(4, 4, &[0; 47]).unwrap_err();
        assert_eq!(error.to_string(), "4 x 4 pixels of 3 bytes need 48 bytes, got 47");
        assert!(EncodedImage::jpeg(0, 4, &[], 90).is_err());
    }
}
