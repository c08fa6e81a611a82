//! Which map colour a pixel shows: exactly, or from a table that is compiled for the light of the moment; and what hangs together.

mod blobs;
mod classifier;
mod table;

pub(crate) use blobs::blobs_of_spans;
pub use blobs::{Blob, find_blobs};
pub use classifier::Classifier;
pub(crate) use classifier::most_probable;
pub use table::LookUpTable;

/// Label of a pixel that shows no colour of the map.
pub(crate) const NO_COLOR: u8 = u8::MAX;
