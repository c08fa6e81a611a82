//! MCAP files: with Foxglove protobuf messages, read and written, and with those of ROS 2, read.

mod camera;
mod cloud;
mod frames;
mod measurement;
mod origin;
mod reading;
mod record;
mod scan;
pub mod topics;
mod vehicle;
mod writing;

pub use reading::file::McapMessageSink;
pub(crate) use reading::folder::{files_in, files_of};
pub(crate) use reading::reader::McapRecords;
pub use writing::drawing::{DrawingShape, ImageOutline, ViewerDrawing};
pub use writing::sink::{ChannelKey, FoxgloveMessage, FoxgloveMessageSink, MessageSinks};
pub use writing::writer::{FoxgloveMessageWriter, McapWriter};
