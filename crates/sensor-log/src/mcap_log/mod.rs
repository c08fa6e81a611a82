//! MCAP files: with Foxglove protobuf messages, read and written, and with those of ROS 2, read.

mod camera;
mod chunk;
mod cloud;
mod decode;
mod drawing;
mod encode;
mod fields;
mod file;
mod folder;
mod frames;
mod origin;
mod parts;
mod pending_cloud;
mod reader;
mod record;
mod reorder;
mod routes;
mod scan;
mod sink;
mod stream;
mod topic_clock;
mod topic_listing;
pub mod topics;
mod vehicle;
mod writer;

pub use drawing::{Drawing, ImageOutline, Shape};
pub use file::McapFile;
pub(crate) use folder::{files_in, files_of};
pub(crate) use reader::McapRecords;
pub use sink::{ChannelKey, Message, MessageSink, Sinks};
pub use writer::{McapWriter, MessageWriter};
