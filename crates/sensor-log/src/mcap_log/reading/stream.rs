use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use mcap::MAGIC;
use mcap::records::op;

use super::super::frames::{Frame, Frames};
use super::chunk::ChunkRecords;
use crate::formats::unsupported_format;
use crate::{LogCompleteness, LogError, LogFormat};

/// The records of an MCAP file in file order, including those in chunks; memory use does not grow with the file.
pub(in crate::mcap_log) struct RecordStream {
    frames: Frames<BufReader<File>>,
    chunk: Option<ChunkRecords>,
}

/// Result of a step through the file.
pub(in crate::mcap_log) enum Step {
    /// A record, or the beginning or end of a chunk.
    On,
    /// A chunk that cannot be unpacked; reading can continue after it.
    DamagedChunk(String),
    /// The last chunk breaks off; its beginning follows.
    Cut(LogCompleteness),
    /// The end.
    End(LogCompleteness),
}

impl RecordStream {
    pub(in crate::mcap_log) fn open(path: &Path) -> Result<Self, LogError> {
        let io = |source| LogError::io(path, source);
        let mut reader = BufReader::new(File::open(path).map_err(io)?);
        let mut magic = Vec::new();
        (&mut reader).take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(io)?;
        if magic.is_empty() {
            return Err(LogError::Empty { path: path.into() });
        }
        if magic != MAGIC {
            unsupported_format::check(path)?;
            let reason = "it does not begin with the magic bytes of MCAP".to_owned();
            return Err(LogError::NotThisFormat { path: path.into(), format: LogFormat::Mcap, reason });
        }
        Ok(Self { frames: Frames::new(reader), chunk: None })
    }

    /// Goes on to the next record and hands it, opcode and body, to `take`.
    pub(in crate::mcap_log) fn step(&mut self, take: impl FnOnce(u8, &[u8])) -> Step {
        if let Some(chunk) = &mut self.chunk {
            let (outcome, is_truncated) = (chunk.with_next(take), chunk.is_truncated());
            match outcome {
                Some(Ok(())) => return Step::On,
                Some(Err(error)) if !is_truncated => {
                    self.chunk = None;
                    return Step::DamagedChunk(error.to_string());
                }
                Some(Err(_)) | None => self.chunk = None,
            }
            return Step::On;
        }
        match self.frames.next() {
            Frame::Record { opcode: op::CHUNK, body } => {
                self.chunk = Some(ChunkRecords::whole(&body));
                Step::On
            }
            Frame::Record { opcode, body } => {
                take(opcode, &body);
                Step::On
            }
            Frame::TruncatedChunk { body, end } => {
                self.chunk = Some(ChunkRecords::cut(&body));
                Step::Cut(end)
            }
            Frame::End(end) => Step::End(end),
        }
    }
}
