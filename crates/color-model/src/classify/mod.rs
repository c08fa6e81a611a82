//! Classification of pixels into map colours, exactly or by a table compiled for the current light, and connected components.

mod blobs;
mod classifier;
mod table;

pub(crate) use blobs::blobs_of_spans;
pub use blobs::{ColorBlob, find_blobs};
pub use classifier::PixelClassifier;
pub use table::ColorLookUpTable;

/// Label of a pixel that shows no colour of the map.
pub(crate) const NO_COLOR: u8 = u8::MAX;
