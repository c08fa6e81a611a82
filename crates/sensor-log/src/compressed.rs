//! Text files, gzip or not: what they are, their first bytes say.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use crate::{LogEnd, LogError};

const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// The text of a file.
pub(crate) type TextReader = Box<dyn BufRead + Send>;

/// Opens a text file and unpacks it on the way where it is compressed.
pub(crate) fn open_text(path: &Path) -> Result<TextReader, LogError> {
    let io = |source| LogError::io(path, source);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let is_gzip = file.fill_buf().map_err(io)?.starts_with(&GZIP_MAGIC);
    Ok(if is_gzip { Box::new(BufReader::new(MultiGzDecoder::new(file))) } else { Box::new(file) })
}

/// How a compressed log ends that broke off or went bad after `n_bytes` of text; `None` when the trouble is another.
pub(crate) fn end_of_damaged(path: &Path, error: &io::Error, n_bytes: u64) -> Option<LogEnd> {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            let file_bytes = fs::metadata(path).map_or(0, |metadata| metadata.len());
            Some(LogEnd::Truncated { file_bytes, missing_bytes: 1 })
        }
        // What the decoder calls a corrupt stream or a wrong checksum.
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => {
            Some(LogEnd::Damaged { byte: n_bytes, reason: error.to_string() })
        }
        _ => None,
    }
}
