//! Text files, plain or gzipped, detected by their first bytes.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use crate::{LogCompleteness, LogError};

const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Byte-order mark of UTF-8, written by editors on Windows.
const BYTE_ORDER_MARK: [u8; 3] = [0xef, 0xbb, 0xbf];

/// The text of a file.
pub(crate) type TextReader = Box<dyn BufRead + Send>;

/// Opens a text file, skips its byte-order mark, and decompresses it if necessary. UTF-16 is an error of its own.
pub(crate) fn open_text(path: &Path) -> Result<TextReader, LogError> {
    let io = |source| LogError::io(path, source);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let is_gzip = file.fill_buf().map_err(io)?.starts_with(&GZIP_MAGIC);
    let mut text: TextReader =
        if is_gzip { Box::new(BufReader::new(MultiGzDecoder::new(file))) } else { Box::new(file) };
    // Damage at the beginning is reported when the text is read.
    let beginning = text.fill_buf().unwrap_or_default();
    if is_utf16(beginning) {
        return Err(LogError::Utf16 { path: path.into() });
    }
    if beginning.starts_with(&BYTE_ORDER_MARK) {
        text.consume(BYTE_ORDER_MARK.len());
    }
    Ok(text)
}

/// The whole text of a file without its byte-order mark, unpacked where it is compressed with gzip.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("params.toml");
/// std::fs::write(&path, "\u{feff}laser = [0.4, 0.0, 0.0]")?;
/// assert_eq!(wayfix_sensor_log::read_text(&path)?, "laser = [0.4, 0.0, 0.0]");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns an error if the file cannot be read, or is no text in UTF-8.
pub fn read_text(path: &Path) -> Result<String, LogError> {
    let mut text = String::new();
    open_text(path)?.read_to_string(&mut text).map_err(|source| LogError::io(path, source))?;
    Ok(text)
}

/// Whether a text begins like UTF-16: with its byte-order mark, or with two ASCII characters and zero bytes.
fn is_utf16(beginning: &[u8]) -> bool {
    match beginning {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        [a, 0, b, 0, ..] | [0, a, 0, b, ..] => [a, b].iter().all(|byte| matches!(byte, b' '..=b'~')),
        _ => false,
    }
}

/// End of a compressed log that is truncated or damaged after `n_bytes` of text; `None` for other errors.
pub(crate) fn end_of_damaged(path: &Path, error: &io::Error, n_bytes: u64) -> Option<LogCompleteness> {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            let file_bytes = fs::metadata(path).map_or(0, |metadata| metadata.len());
            Some(LogCompleteness::Truncated { file_bytes, missing_bytes: 1 })
        }
        // Error kinds of the decoder for a corrupt stream or a wrong checksum.
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => {
            Some(LogCompleteness::Damaged { byte: n_bytes, reason: error.to_string() })
        }
        _ => None,
    }
}
