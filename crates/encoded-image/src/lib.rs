//! Camera images as logs store them: files, compressed or not, decoded on demand.
//!
//! | question | item |
//! | --- | --- |
//! | What does a log store, and what are its pixels? | [`EncodedImage`], [`DecodedImage`] |
//! | Which image is in a message of ROS 2 or Foxglove? | [`compressed_message`], [`RawPixels`] |
//! | In which order are numbered files? | [`natural_key`] |
//! | Which images does a log hold? | [`LogImageStatistics`] |

mod complete;
mod decode;
mod encode;
mod encoded;
mod error;
mod huffman;
mod message;
mod natural_order;
mod pixels;
mod pnm;
mod summary;

pub use encoded::{DecodedImage, EncodedImage, ImageFileFormat, PixelLayout};
pub use error::ImageError;
pub use message::compressed_message;
pub use natural_order::natural_key;
pub use pixels::RawPixels;
pub use pnm::Anymap;
pub use summary::LogImageStatistics;
