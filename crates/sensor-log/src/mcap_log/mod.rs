//! MCAP files with Foxglove protobuf messages.

mod camera;
mod chunk;
mod cloud;
mod decode;
mod drawing;
mod encode;
mod fields;
mod frames;
mod held;
mod origin;
mod reader;
mod record;
mod reorder;
mod routes;
mod scan;
pub mod topics;
mod vehicle;
mod writer;

pub use drawing::{Drawing, ImageOutline, Shape};
pub(crate) use reader::McapRecords;
pub use writer::McapWriter;
