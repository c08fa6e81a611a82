//! Camera images as logs hold them: compressed, decoded when somebody wants to see them.

mod decode;
mod encode;
mod encoded;
mod error;
mod summary;
mod whole;

pub use encoded::{DecodedImage, EncodedImage, ImageFormat, PixelLayout};
pub use error::ImageError;
pub use summary::ImageSummary;
