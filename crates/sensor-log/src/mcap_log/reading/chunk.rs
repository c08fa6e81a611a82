use std::io::{Cursor, Read};

use mcap::McapResult;
use mcap::records::op;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::super::frames::MAX_RECORD_BYTES;

/// The records inside one chunk, decompressed.
pub(in crate::mcap_log) struct ChunkRecords {
    reader: LinearReader,
    bytes: Cursor<Vec<u8>>,
    is_truncated: bool,
}

impl ChunkRecords {
    /// A complete chunk; its checksum is verified before the first record is returned.
    pub(in crate::mcap_log) fn whole(body: &[u8]) -> Self {
        Self::new(body, false)
    }

    /// The beginning of a truncated chunk: returns its complete records, without a checksum.
    pub(in crate::mcap_log) fn cut(body: &[u8]) -> Self {
        Self::new(body, true)
    }

    fn new(body: &[u8], is_truncated: bool) -> Self {
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_prevalidate_chunk_crcs(!is_truncated)
            .with_record_length_limit(MAX_RECORD_BYTES);
        // The library reads chunks from a file, so wrap it in one again. A truncated chunk claims a larger size.
        let claimed = if is_truncated { MAX_RECORD_BYTES as u64 } else { body.len() as u64 };
        let mut bytes = vec![op::CHUNK];
        bytes.extend(claimed.to_le_bytes());
        bytes.extend_from_slice(body);
        Self { reader: LinearReader::new_with_options(options), bytes: Cursor::new(bytes), is_truncated }
    }

    /// Whether the chunk is truncated, so that an error is expected.
    pub(in crate::mcap_log) fn is_truncated(&self) -> bool {
        self.is_truncated
    }

    /// Hands the next record, its opcode and body, to `take`; `None` at the end.
    pub(in crate::mcap_log) fn with_next<T>(
        &mut self,
        take: impl FnOnce(u8, &[u8]) -> T,
    ) -> Option<McapResult<T>> {
        loop {
            match self.reader.next_event()? {
                Err(error) => return Some(Err(error)),
                Ok(LinearReadEvent::Record { opcode, data }) => return Some(Ok(take(opcode, data))),
                Ok(LinearReadEvent::ReadRequest(n_wanted)) => {
                    // Limit the buffer to the remaining bytes; an empty one signals the end.
                    let n_left = self.bytes.get_ref().len() - self.bytes.position() as usize;
                    let n_read = match self.bytes.read(self.reader.insert(n_wanted.min(n_left))) {
                        Ok(n_read) => n_read,
                        Err(error) => return Some(Err(error.into())),
                    };
                    self.reader.notify_read(n_read);
                }
            }
        }
    }
}
