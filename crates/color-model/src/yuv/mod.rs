//! Images in YUV, by the standard that says what YUV is.

mod image;
mod standard;

pub use image::YuvImage;
pub use standard::YuvStandard;
