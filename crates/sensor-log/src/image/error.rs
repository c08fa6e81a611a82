use image::ExtendedColorType;

use super::ImageFileFormat;

/// Errors of encoding and decoding images.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The pixels do not fill the image.
    #[error("{width} x {height} pixels of {channels} bytes need {expected} bytes, got {got}")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Bytes a pixel.
        channels: u32,
        /// Bytes that are needed.
        expected: u64,
        /// Number of bytes given.
        got: u64,
    },
    /// No pixels at all.
    #[error("an image of {width} x {height} pixels has nothing in it")]
    Empty {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The header claims more pixels than are decoded.
    #[error("{width} x {height} pixels are more than the {max} that are decoded")]
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Pixels that are decoded at most.
        max: u64,
    },
    /// The file breaks off before its end mark.
    #[error("the image breaks off after {n_bytes} bytes")]
    Truncated {
        /// Bytes that are there.
        n_bytes: usize,
    },
    /// The image holds no labels.
    #[error("labels are 8-bit grey PNG, this is {} with pixels {color:?}", format.name())]
    NotLabels {
        /// Its compression.
        format: ImageFileFormat,
        /// Its pixel format.
        color: ExtendedColorType,
    },
    /// An error of the codec: damaged data, or another format than stated.
    #[error("{}", .0.to_string().trim_end())]
    Codec(image::ImageError),
}
