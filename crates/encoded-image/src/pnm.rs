//! Uncompressed images: portable anymaps, `P5` for grey and `P6` for colours, of eight bits a channel [netpbm, pgm(5) and ppm(5)].

use crate::{EncodedImage, ImageError, ImageFileFormat};

impl EncodedImage {
    /// RGB pixels after a short header with their number.
    /// ```
    /// use wayfix_encoded_image::EncodedImage;
    /// let image = EncodedImage::pnm_rgb(1, 2, &[255, 0, 0, 0, 0, 255])?;
    /// assert_eq!(&image.bytes[..], b"P6\n1 2\n255\n\xFF\0\0\0\0\xFF");
    /// assert_eq!(image.decode_rgb()?.pixels, [255, 0, 0, 0, 0, 255]);
    /// # Ok::<(), wayfix_encoded_image::ImageError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the pixels do not fill the image or there are none.
    pub fn pnm_rgb(width: u32, height: u32, rgb: &[u8]) -> Result<Self, ImageError> {
        crate::encode::check(width, height, 3, rgb)?;
        Ok(pnm("P6", width, height, rgb))
    }

    /// Grey pixels, a byte each, as they are.
    ///
    /// # Errors
    /// Returns an error if the pixels do not fill the image or there are none.
    pub fn pnm_gray(width: u32, height: u32, gray: &[u8]) -> Result<Self, ImageError> {
        crate::encode::check(width, height, 1, gray)?;
        Ok(pnm("P5", width, height, gray))
    }
}

/// The pixels of a file of our own form, without a copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Anymap<'a> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 1 or 3.
    pub channels: u32,
    /// Row by row from the upper left; fewer than the header claims if the file is truncated.
    pub pixels: &'a [u8],
}

impl<'a> Anymap<'a> {
    /// Returns `None` unless the header has eight bits per channel.
    pub fn of(bytes: &'a [u8]) -> Option<Self> {
        let channels = match bytes {
            [b'P', b'5', ..] => 1,
            [b'P', b'6', ..] => 3,
            _ => return None,
        };
        let mut rest = &bytes[2..];
        let [width, height, largest] = [number(&mut rest)?, number(&mut rest)?, number(&mut rest)?];
        let (space, pixels) = rest.split_first()?;
        (largest == 255 && space.is_ascii_whitespace()).then_some(Self { width, height, channels, pixels })
    }

    /// Whether all pixels are there.
    pub fn is_complete(&self) -> bool {
        let n_bytes = u64::from(self.width) * u64::from(self.height) * u64::from(self.channels);
        u64::try_from(self.pixels.len()).is_ok_and(|n_there| n_there >= n_bytes)
    }
}

/// The next decimal number, after blanks and comments.
fn number(rest: &mut &[u8]) -> Option<u32> {
    loop {
        *rest = rest.trim_ascii_start();
        match rest.strip_prefix(b"#") {
            Some(comment) => *rest = &comment[comment.iter().position(|byte| *byte == b'\n')?..],
            None => break,
        }
    }
    let n_digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (digits, after) = rest.split_at(n_digits);
    *rest = after;
    std::str::from_utf8(digits).ok()?.parse().ok()
}

fn pnm(magic: &str, width: u32, height: u32, pixels: &[u8]) -> EncodedImage {
    let header = format!("{magic}\n{width} {height}\n255\n");
    EncodedImage::new(ImageFileFormat::Pnm, [header.as_bytes(), pixels].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_other_programs_have_comments_and_other_blanks() {
        let bytes = b"P5 # made by hand\n# 7 7\n 2\t1 # wide\n255\n\x01\x02";
        let expected = Anymap { width: 2, height: 1, channels: 1, pixels: &[1, 2] };
        assert_eq!(Anymap::of(bytes), Some(expected));
        let image = EncodedImage::new(ImageFileFormat::Pnm, &bytes[..]);
        assert_eq!(image.decode_gray().unwrap().pixels, [1, 2]);
    }

    #[test]
    fn what_is_cut_short_anywhere_or_deeper_than_a_byte_is_an_error() {
        let whole = EncodedImage::pnm_rgb(3, 2, &[7; 18]).unwrap();
        assert_eq!(whole.size().unwrap(), (3, 2));
        for n_bytes in 0..whole.bytes.len() {
            let cut = EncodedImage::new(ImageFileFormat::Pnm, &whole.bytes[..n_bytes]);
            assert!(cut.size().is_err() && cut.decode_rgb().is_err(), "cut after {n_bytes} bytes");
        }
        assert_eq!(Anymap::of(b"P5\n1 1\n65535\n\0\0"), None);
        assert_eq!(Anymap::of(b"P6\n4294967296 1\n255\n\0"), None);
        assert_eq!(Anymap::of(b"P6\n# without end"), None);
    }

    #[test]
    fn oversized_header_is_refused_before_allocation() {
        let huge = EncodedImage::new(ImageFileFormat::Pnm, &b"P6\n4000000000 4000000000\n255\n123"[..]);
        assert!(huge.decode_rgb().is_err());
    }
}
