use std::io::{self, Read};

use mcap::MAGIC;
use mcap::records::op;

use crate::LogCompleteness;

/// No sane writer makes larger chunks or messages; a damaged length must not fill the memory.
pub(super) const MAX_RECORD_BYTES: usize = 128 << 20;

/// Upper bound of a file's size; a skipped attachment may have any size below it.
const MAX_FILE_BYTES: u64 = 1 << 50;

/// Larger metadata records are not ours and are skipped.
const MAX_METADATA_BYTES: u64 = 1 << 16;

/// Opcode and length before each record.
const HEAD_BYTES: usize = 9;
/// Size of the end of a complete file: the footer record and the magic.
const FOOTER_BYTES: u64 = HEAD_BYTES as u64 + 20;
const DATA_END_BYTES: u64 = HEAD_BYTES as u64 + 4;

/// Reads the top-level records of an MCAP file one at a time, and finds the point at which it is truncated or damaged.
pub(super) struct Frames<R> {
    reader: R,
    offset: u64,
    seen_data_end: bool,
    finished: bool,
}

/// One step through the file.
pub(super) enum Frame {
    /// A chunk, schema, channel, message or metadata, whole.
    Record { opcode: u8, body: Vec<u8> },
    /// The beginning of a chunk after which the file breaks off.
    TruncatedChunk { body: Vec<u8>, end: LogCompleteness },
    /// No more records.
    End(LogCompleteness),
}

impl<R: Read> Frames<R> {
    /// `reader` is positioned after the magic.
    pub(super) fn new(reader: R) -> Self {
        Self { reader, offset: MAGIC.len() as u64, seen_data_end: false, finished: false }
    }

    /// The next relevant record; skips the others.
    pub(super) fn next(&mut self) -> Frame {
        while !self.finished {
            match self.step() {
                Ok(None) => {}
                Ok(Some(frame)) => {
                    self.finished = !matches!(frame, Frame::Record { .. });
                    return frame;
                }
                Err(error) => {
                    self.finished = true;
                    return self.damaged(error.to_string());
                }
            }
        }
        Frame::End(LogCompleteness::Complete)
    }

    fn step(&mut self) -> io::Result<Option<Frame>> {
        let mut head = Vec::with_capacity(HEAD_BYTES);
        let n_head = self.read_up_to(HEAD_BYTES as u64, &mut head)?;
        let Ok(head) = <[u8; HEAD_BYTES]>::try_from(head.as_slice()) else {
            return Ok(Some(Frame::End(self.truncated_in_head(head.first().copied(), n_head))));
        };
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        match opcode {
            0 => Ok(Some(self.damaged("record of the impossible kind 0".to_owned()))),
            op::CHUNK | op::SCHEMA | op::CHANNEL | op::MESSAGE if !self.seen_data_end => {
                self.keep(opcode, length)
            }
            op::METADATA if length <= MAX_METADATA_BYTES => self.keep(opcode, length),
            _ if length > MAX_FILE_BYTES => {
                Ok(Some(self.damaged(format!("record of kind {opcode} claims {length} bytes"))))
            }
            _ => self.pass_over(opcode, length),
        }
    }

    fn keep(&mut self, opcode: u8, length: u64) -> io::Result<Option<Frame>> {
        if length > MAX_RECORD_BYTES as u64 {
            let reason = format!("record claims {length} bytes, the limit is {MAX_RECORD_BYTES}");
            return Ok(Some(self.damaged(reason)));
        }
        let mut body = Vec::new();
        let n_bytes = self.read_up_to(length, &mut body)?;
        Ok(Some(match (n_bytes == length, opcode) {
            (true, _) => Frame::Record { opcode, body },
            (false, op::CHUNK) => Frame::TruncatedChunk { body, end: self.truncated(length - n_bytes) },
            (false, _) => Frame::End(self.truncated(length - n_bytes)),
        }))
    }

    fn pass_over(&mut self, opcode: u8, length: u64) -> io::Result<Option<Frame>> {
        let n_bytes = io::copy(&mut (&mut self.reader).take(length), &mut io::sink())?;
        self.offset = self.offset.saturating_add(n_bytes);
        self.seen_data_end |= opcode == op::DATA_END;
        if n_bytes < length {
            let owed_later = match opcode {
                op::FOOTER => MAGIC.len() as u64,
                _ => self.owed(),
            };
            return Ok(Some(Frame::End(self.truncated_by((length - n_bytes).saturating_add(owed_later)))));
        }
        if opcode != op::FOOTER {
            return Ok(None);
        }
        let n_magic = self.read_up_to(MAGIC.len() as u64, &mut Vec::new())?;
        Ok(Some(Frame::End(match MAGIC.len() as u64 - n_magic {
            0 => LogCompleteness::Complete,
            missing => self.truncated_by(missing),
        })))
    }

    fn read_up_to(&mut self, limit: u64, bytes: &mut Vec<u8>) -> io::Result<u64> {
        let n_bytes = (&mut self.reader).take(limit).read_to_end(bytes)? as u64;
        self.offset += n_bytes;
        Ok(n_bytes)
    }

    /// The least that must follow a whole record in a whole file.
    fn owed(&self) -> u64 {
        let data_end = if self.seen_data_end { 0 } else { DATA_END_BYTES };
        data_end + FOOTER_BYTES + MAGIC.len() as u64
    }

    fn truncated_in_head(&mut self, opcode: Option<u8>, n_head: u64) -> LogCompleteness {
        let owed = match opcode {
            None | Some(op::DATA_END | op::FOOTER) => self.owed() - n_head,
            Some(_) => HEAD_BYTES as u64 - n_head + self.owed(),
        };
        self.truncated_by(owed)
    }

    fn truncated(&self, missing_of_record: u64) -> LogCompleteness {
        self.truncated_by(missing_of_record.saturating_add(self.owed()))
    }

    fn truncated_by(&self, missing_bytes: u64) -> LogCompleteness {
        LogCompleteness::Truncated { file_bytes: self.offset, missing_bytes }
    }

    fn damaged(&self, reason: String) -> Frame {
        Frame::End(LogCompleteness::Damaged { byte: self.offset, reason })
    }
}
