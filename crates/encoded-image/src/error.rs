use image::ExtendedColorType;

use crate::ImageFileFormat;

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
    /// A message holds no picture.
    #[error("image called {called:?} {why} ({n_bytes} bytes)")]
    NoPicture {
        /// The sender's name of the format.
        called: String,
        /// What it is instead.
        why: &'static str,
        /// Bytes in the message.
        n_bytes: usize,
    },
    /// The rows of raw pixels do not fit into the bytes.
    #[error("{width} x {height} pixels {encoding} in rows of {step} bytes do not fit into {n_bytes} bytes")]
    Rows {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Name of the pixel format.
        encoding: String,
        /// Bytes from one row to the next.
        step: u32,
        /// Bytes that are there.
        n_bytes: usize,
    },
    /// The format of raw pixels is not read.
    #[error("pixels {encoding:?} are not read; mono8, rgb8, bgr8, rgba8 and bgra8 are")]
    Encoding {
        /// Its name.
        encoding: String,
    },
    /// An error of the codec: damaged data, or another format than stated.
    #[error("{}", .0.to_string().trim_end())]
    Codec(image::ImageError),
}
