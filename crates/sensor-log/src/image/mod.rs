//! Camera images as logs hold them: compressed, decoded when somebody wants to see them.

mod decode;
mod encode;
mod encoded;
mod error;

pub use encoded::{DecodedImage, EncodedImage, ImageFormat};
pub use error::ImageError;
