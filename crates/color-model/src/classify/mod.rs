//! Which map colour a pixel shows: exactly, or from a table that is compiled for the light of the moment.

mod classifier;
mod table;

pub use classifier::Classifier;
pub use table::LookUpTable;
