/// Why an image could not be encoded or decoded.
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
        /// Bytes that were given.
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
    /// The codec refuses: damaged, of another format than it says, or larger than allowed.
    #[error("{0}")]
    Codec(image::ImageError),
}
