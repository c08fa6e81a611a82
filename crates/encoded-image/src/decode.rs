use std::borrow::Cow;
use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, ExtendedColorType, ImageDecoder, ImageReader, Limits};

use crate::huffman::with_huffman_tables;
use crate::{DecodedImage, EncodedImage, ImageError, ImageFileFormat, PixelLayout};

/// Pixels of the largest image that is decoded; a damaged or hostile header must not fill the memory.
const MAX_PIXELS: u64 = 64 << 20;
/// Allocation limit of a decoder: the deepest pixels, four channels of two bytes, and an equal working buffer.
const MAX_BYTES: u64 = 2 * 8 * MAX_PIXELS;

/// Decoding gives equal pixels with AVX2 and without vector instructions (`tests/integration/image_portability.rs`; Neon is not measured yet). Images are
/// rotated by their EXIF orientation. A JPEG without Huffman tables, as from webcams, gets those of the standard.
impl EncodedImage {
    /// Columns and rows of the upright image, from the header; no pixel is decoded.
    ///
    /// # Errors
    /// Returns an error if the file is cut short, its header is damaged or of another format, or it claims no pixel or more than 64 Mi.
    pub fn size(&self) -> Result<(u32, u32), ImageError> {
        let mut decoder = self.decoder()?;
        let (width, height) = decoder.dimensions();
        let is_on_its_side = orientation(&mut decoder).to_exif() > 4;
        Ok(if is_on_its_side { (height, width) } else { (width, height) })
    }

    /// The EXIF orientation of an image that is not stored upright, 2 to 8; decoding corrects it.
    pub fn orientation(&self) -> Option<u8> {
        let orientation = orientation(&mut self.decoder().ok()?);
        (orientation != Orientation::NoTransforms).then(|| orientation.to_exif())
    }

    /// Pixel layout of the file, from the header; it shows what a decoding to eight-bit colour will change.
    /// # Errors
    /// Returns the errors of [`size`](Self::size).
    pub fn layout(&self) -> Result<PixelLayout, ImageError> {
        let color = self.decoder()?.original_color_type();
        let channels = color.channel_count();
        let bits_per_channel = color.bits_per_pixel() / u16::from(channels.max(1));
        Ok(PixelLayout { channels, bits_per_channel })
    }

    /// Decodes to colour: grey becomes colour, deeper channels are rounded to eight bits, transparency is dropped.
    /// # Errors
    /// Returns the errors of [`size`](Self::size), and an error if the pixels are damaged. A JPEG file has no checksum, so damage may only change pixels.
    pub fn decode_rgb(&self) -> Result<DecodedImage, ImageError> {
        let image = self.decode()?.into_rgb8();
        Ok(DecodedImage { width: image.width(), height: image.height(), pixels: image.into_raw() })
    }

    /// The image in grey: for a grey image its own bytes, else luma of its colours.
    ///
    /// # Errors
    /// Returns the errors of [`decode_rgb`](Self::decode_rgb).
    pub fn decode_gray(&self) -> Result<DecodedImage, ImageError> {
        let image = self.decode()?.into_luma8();
        Ok(DecodedImage { width: image.width(), height: image.height(), pixels: image.into_raw() })
    }

    /// Decodes the labels of an image: the bytes of a grey PNG, without conversion.
    /// # Errors
    /// Returns the errors of [`decode_rgb`](Self::decode_rgb), and an error if the image is not a PNG of eight grey bits.
    pub fn decode_labels(&self) -> Result<DecodedImage, ImageError> {
        let color = self.decoder()?.original_color_type();
        if self.format != ImageFileFormat::Png || color != ExtendedColorType::L8 {
            return Err(ImageError::NotLabels { format: self.format, color });
        }
        self.decode_gray()
    }

    fn decode(&self) -> Result<DynamicImage, ImageError> {
        let mut decoder = self.decoder()?;
        let orientation = orientation(&mut decoder);
        let mut image = DynamicImage::from_decoder(decoder).map_err(ImageError::Codec)?;
        image.apply_orientation(orientation);
        Ok(image)
    }

    /// A decoder that has read the header.
    fn decoder(&self) -> Result<impl ImageDecoder + '_, ImageError> {
        let format = match self.format {
            ImageFileFormat::Jpeg => image::ImageFormat::Jpeg,
            ImageFileFormat::Png => image::ImageFormat::Png,
            ImageFileFormat::Pnm => image::ImageFormat::Pnm,
        };
        let mut limits = Limits::default();
        limits.max_alloc = Some(MAX_BYTES);
        let bytes = match self.format {
            ImageFileFormat::Jpeg => with_huffman_tables(&self.bytes),
            ImageFileFormat::Png | ImageFileFormat::Pnm => Cow::Borrowed(&*self.bytes),
        };
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(ImageError::Codec)?;
        let (width, height) = decoder.dimensions();
        match u64::from(width) * u64::from(height) {
            0 => Err(ImageError::Empty { width, height }),
            n_pixels if n_pixels > MAX_PIXELS => Err(ImageError::TooLarge { width, height, max: MAX_PIXELS }),
            _ if !self.format.is_complete(&self.bytes) => {
                Err(ImageError::Truncated { n_bytes: self.bytes.len() })
            }
            _ => Ok(decoder),
        }
    }
}

/// Damaged EXIF data are ignored.
fn orientation(decoder: &mut impl ImageDecoder) -> Orientation {
    decoder.orientation().unwrap_or(Orientation::NoTransforms)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32) -> Vec<u8> {
        (0..width * height).flat_map(|k| [k as u8, (k / 2) as u8, 128]).collect()
    }

    fn png_of(image: impl Into<DynamicImage>) -> EncodedImage {
        let mut bytes = Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        EncodedImage::new(ImageFileFormat::Png, bytes.into_inner())
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
    fn what_is_cut_short_anywhere_is_an_error() {
        let rgb = ramp(32, 16);
        for whole in [EncodedImage::jpeg(32, 16, &rgb, 90), EncodedImage::png_rgb(32, 16, &rgb)] {
            let whole = whole.unwrap();
            assert_eq!(whole.size().unwrap(), (32, 16));
            for n_bytes in 0..whole.bytes.len() {
                let cut = EncodedImage::new(whole.format, &whole.bytes[..n_bytes]);
                assert!(cut.size().is_err(), "{whole:?} cut after {n_bytes} bytes");
                assert!(cut.decode_rgb().is_err(), "{whole:?} cut after {n_bytes} bytes");
            }
        }
    }

    #[test]
    fn what_is_of_another_format_than_it_says_is_an_error() {
        let jpeg = EncodedImage::jpeg(4, 4, &ramp(4, 4), 90).unwrap();
        assert!(EncodedImage::new(ImageFileFormat::Png, jpeg.bytes).decode_rgb().is_err());
        assert!(EncodedImage::new(ImageFileFormat::Jpeg, &b"GIF89a"[..]).size().is_err());
    }

    /// The header chunk has its checksum after 4 + 4 + 13 bytes; a decoder checks it first.
    fn with_claimed_size(png: &EncodedImage, width: u32, height: u32) -> EncodedImage {
        let mut bytes = png.bytes.to_vec();
        bytes[16..20].copy_from_slice(&width.to_be_bytes());
        bytes[20..24].copy_from_slice(&height.to_be_bytes());
        let crc = bytes[12..29].iter().fold(u32::MAX, |crc, byte| {
            (0..8)
                .fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg()))
        });
        bytes[29..33].copy_from_slice(&(!crc).to_be_bytes());
        EncodedImage::new(ImageFileFormat::Png, bytes)
    }

    #[test]
    fn oversized_header_is_refused_before_decoding() {
        let png = EncodedImage::png_gray(4, 4, &[7; 16]).unwrap();
        let side = 1 << 13;
        let error = with_claimed_size(&png, side, side + 1).decode_gray().unwrap_err();
        assert!(
            matches!(error, ImageError::TooLarge { width, height, max } if u64::from(width) * u64::from(height - 1) == max),
            "{error}"
        );
        assert!(with_claimed_size(&png, i32::MAX as u32, i32::MAX as u32).size().is_err());
        assert!(with_claimed_size(&png, 0, 4).decode_rgb().is_err());
        // The same size, to show that the altered checksum is not the cause of the error.
        assert_eq!(with_claimed_size(&png, 4, 4).decode_gray().unwrap().pixels, [7; 16]);

        let mut jpeg = EncodedImage::jpeg(4, 4, &ramp(4, 4), 90).unwrap().bytes.to_vec();
        let frame = jpeg.windows(2).position(|pair| pair == [0xFF, 0xC0]).unwrap();
        jpeg[frame + 5..frame + 9].fill(0xFF);
        let error = EncodedImage::new(ImageFileFormat::Jpeg, jpeg).decode_rgb().unwrap_err();
        assert!(matches!(error, ImageError::TooLarge { width: 65_535, height: 65_535, .. }), "{error}");
    }

    #[test]
    fn other_depths_and_channels_become_rgb_as_stated() {
        let deep =
            png_of(image::ImageBuffer::from_pixel(3, 2, image::Rgb([65_535_u16, 257 * 100 + 120, 140])));
        assert_eq!(deep.decode_rgb().unwrap().pixels[..3], [255, 100, 1]);
        assert_eq!(deep.layout().unwrap(), PixelLayout { channels: 3, bits_per_channel: 16 });
        let transparent = png_of(image::RgbaImage::from_pixel(3, 2, image::Rgba([10, 20, 30, 0])));
        assert_eq!(transparent.decode_rgb().unwrap().pixels[..3], [10, 20, 30]);
        assert!(transparent.layout().unwrap().has_alpha());
        let grey = EncodedImage::png_gray(2, 1, &[9, 200]).unwrap();
        assert_eq!(grey.decode_rgb().unwrap().pixels, [9, 9, 9, 200, 200, 200]);
        assert_eq!(grey.layout().unwrap(), PixelLayout { channels: 1, bits_per_channel: 8 });
    }

    /// Inserts an EXIF segment with only an orientation, after the start of the image.
    fn with_orientation(jpeg: &EncodedImage, orientation: u8) -> EncodedImage {
        let mut exif = b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
        exif.extend([orientation, 0, 0, 0, 0, 0, 0]);
        let length = (exif.len() as u16 + 2).to_be_bytes();
        let bytes = [&jpeg.bytes[..2], &[0xFF, 0xE1], &length, &exif, &jpeg.bytes[2..]].concat();
        EncodedImage::new(ImageFileFormat::Jpeg, bytes)
    }

    #[test]
    fn exif_orientation_turns_size_and_pixels() {
        // Dark on the left, bright on the right.
        let rgb: Vec<u8> = (0..16 * 8).flat_map(|k| [if k % 16 < 8 { 0 } else { 240 }; 3]).collect();
        let upright = EncodedImage::jpeg(16, 8, &rgb, 95).unwrap();
        assert_eq!(upright.orientation(), None);
        let turned = with_orientation(&upright, 6);
        assert_eq!((turned.orientation(), turned.size().unwrap()), (Some(6), (8, 16)));
        let decoded = turned.decode_gray().unwrap();
        // A quarter turn clockwise: left becomes top.
        assert_eq!((decoded.width, decoded.height), (8, 16));
        assert!(decoded.pixels[0] < 30 && decoded.pixels[7] < 30 && decoded.pixels[15 * 8] > 210);
        let mirrored = with_orientation(&upright, 2).decode_gray().unwrap();
        assert!(mirrored.width == 16 && mirrored.pixels[0] > 210 && mirrored.pixels[15] < 30);
    }

    #[test]
    fn labels_are_bytes_of_a_grey_png_and_nothing_else() {
        let labels = [0, 1, 2, 5];
        assert_eq!(EncodedImage::png_gray(2, 2, &labels).unwrap().decode_labels().unwrap().pixels, labels);
        let error = EncodedImage::png_rgb(2, 2, &[3; 12]).unwrap().decode_labels().unwrap_err();
        assert_eq!(error.to_string(), "labels are 8-bit grey PNG, this is png with pixels Rgb8");
        let deep = png_of(image::ImageBuffer::from_pixel(2, 2, image::Luma([3_u16])));
        assert!(matches!(deep.decode_labels(), Err(ImageError::NotLabels { .. })));
        let jpeg = EncodedImage::jpeg(2, 2, &[3; 12], 90).unwrap();
        assert!(matches!(jpeg.decode_labels(), Err(ImageError::NotLabels { .. })));
    }

    #[test]
    fn pixels_that_do_not_fill_the_image_are_refused() {
        let error = EncodedImage::png_rgb(4, 4, &[0; 47]).unwrap_err();
        assert_eq!(error.to_string(), "4 x 4 pixels of 3 bytes need 48 bytes, got 47");
        assert!(EncodedImage::jpeg(0, 4, &[], 90).is_err());
    }
}
