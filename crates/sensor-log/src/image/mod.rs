//! Camera images as stored in logs: files, compressed or not, decoded on demand.

mod complete;
mod decode;
mod encode;
mod encoded;
mod error;
mod huffman;
mod message;
mod pixels;
mod pnm;
mod summary;

pub use encoded::{DecodedImage, EncodedImage, ImageFileFormat, PixelLayout};
pub use error::ImageError;
pub(crate) use message::picture;
pub(crate) use pixels::Pixels;
pub(crate) use pnm::Anymap;
pub use summary::LogImageStatistics;
