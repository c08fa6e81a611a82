use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use mcap::WriteOptions;
use mcap::records::MessageHeader;

use super::super::origin;
use super::super::writing::sink::{ChannelKey, FoxgloveMessage, FoxgloveMessageSink};
use crate::{LogError, LogFormat};

/// Messages are flushed in chunks of about this size: a crash loses no more.
const CHUNK_BYTES: u64 = 256 << 10;

/// Writes messages to an MCAP file. Equal messages give equal bytes: no compression by default, no clock, no library version.
pub struct McapMessageSink<W: Write + Seek> {
    writer: mcap::Writer<W>,
    channels: BTreeMap<ChannelKey, Channel>,
}

struct Channel {
    id: u16,
    sequence: u32,
}

impl McapMessageSink<BufWriter<File>> {
    /// Creates the file, or replaces the one that is there.
    ///
    /// # Errors
    /// Returns an error if it cannot be created.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, LogError> {
        Self::new(new_file(path.as_ref())?)
    }

    /// Creates the file with chunks that are compressed with Zstandard: poses and scans a few times smaller. Equal messages give equal bytes for an equal
    /// version of the library.
    ///
    /// # Errors
    /// Returns an error if it cannot be created.
    #[cfg(feature = "zstd")]
    pub fn create_compressed(path: impl AsRef<Path>) -> Result<Self, LogError> {
        let options = options().compression(Some(mcap::Compression::Zstd)).compression_threads(0);
        Ok(Self { writer: options.create(new_file(path.as_ref())?)?, channels: BTreeMap::new() })
    }
}

fn new_file(path: &Path) -> Result<BufWriter<File>, LogError> {
    let file = File::create(path).map_err(|source| LogError::NotCreated { path: path.into(), source })?;
    Ok(BufWriter::new(file))
}

fn options() -> WriteOptions {
    WriteOptions::new().compression(None).library("wayfix").chunk_size(Some(CHUNK_BYTES))
}

impl<W: Write + Seek> McapMessageSink<W> {
    /// Writes to `out`.
    ///
    /// # Errors
    /// Returns an error if `out` fails.
    pub fn new(out: W) -> Result<Self, LogError> {
        Ok(Self { writer: options().create(out)?, channels: BTreeMap::new() })
    }
}

impl<W: Write + Seek> FoxgloveMessageSink for McapMessageSink<W> {
    fn message(&mut self, message: &FoxgloveMessage<'_>) -> Result<(), LogError> {
        let &FoxgloveMessage { topic, schema, descriptors, metadata, stamp, data } = message;
        let channel = match self.channels.entry(message.channel()) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => {
                let schema_id = self.writer.add_schema(schema, FoxgloveMessage::ENCODING, descriptors)?;
                let id = self.writer.add_channel(schema_id, topic, FoxgloveMessage::ENCODING, metadata)?;
                entry.insert(Channel { id, sequence: 0 })
            }
        };
        let time = stamp.nanoseconds();
        let header = MessageHeader {
            channel_id: channel.id,
            sequence: channel.sequence,
            log_time: time,
            publish_time: time,
        };
        channel.sequence = channel.sequence.wrapping_add(1);
        self.writer.write_to_known_channel(&header, data)?;
        Ok(())
    }

    fn origin(&mut self, origin: LogFormat) -> Result<(), LogError> {
        if origin != LogFormat::Mcap {
            self.writer.write_metadata(&origin::encode(origin))?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), LogError> {
        self.writer.finish()?;
        self.writer.into_inner().flush().map_err(mcap::McapError::from)?;
        Ok(())
    }
}
