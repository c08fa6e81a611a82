//! Images in YUV, by a YUV standard.

mod image;
mod standard;

pub use image::YuvImage;
pub use standard::YuvStandard;
