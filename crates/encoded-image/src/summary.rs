use std::collections::BTreeMap;
use std::fmt;

use crate::{EncodedImage, ImageFileFormat};

/// Image statistics from the headers; `Display` prints them for people.
/// ```
/// use wayfix_encoded_image::{EncodedImage, ImageFileFormat, LogImageStatistics};
/// let mut summary = LogImageStatistics::default();
/// summary.add(&EncodedImage::png_gray(3, 2, &[0; 6])?);
/// summary.add(&EncodedImage::new(ImageFileFormat::Jpeg, &[0xFF, 0xD8, 0xFF][..]));
/// assert_eq!(summary.sizes[&(ImageFileFormat::Png, 3, 2)], 1);
/// assert_eq!(summary.n_damaged, 1);
/// # Ok::<(), wayfix_encoded_image::ImageError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct LogImageStatistics {
    /// Number of images of each format, width and height.
    pub sizes: BTreeMap<(ImageFileFormat, u32, u32), u64>,
    /// Number of images with an unreadable or truncated header.
    pub n_damaged: u64,
    /// Bytes of all of them.
    pub n_bytes: u64,
}

impl LogImageStatistics {
    /// Counts an image.
    pub fn add(&mut self, image: &EncodedImage) {
        self.n_bytes += image.bytes.len() as u64;
        match image.size() {
            Ok((width, height)) => *self.sizes.entry((image.format, width, height)).or_default() += 1,
            Err(_) => self.n_damaged += 1,
        }
    }
}

impl fmt::Display for LogImageStatistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for ((format, width, height), count) in &self.sizes {
            write!(f, "{count} {} of {width} x {height} pixels, ", format.name())?;
        }
        if self.n_damaged > 0 {
            write!(f, "{} damaged, ", self.n_damaged)?;
        }
        write!(f, "{:.1} MB", self.n_bytes as f64 * 1e-6)
    }
}
