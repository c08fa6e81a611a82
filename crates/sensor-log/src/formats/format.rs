use std::fmt;
use std::fs::{self, File};
use std::io::{BufRead, Read};
use std::path::Path;
use std::str::FromStr;

use mcap::MAGIC;

use super::unsupported_format;
use crate::LogError;
use crate::formats::compressed::{TextReader, open_text};
use crate::image_folder::images_in;
use crate::mcap_log::files_in;
use crate::text::{Lines, carmen, range_bearing, tum, utias, victoria_park};

/// Storage format of a log.
/// ```
/// use wayfix_sensor_log::LogFormat;
/// assert_eq!("range-bearing".parse::<LogFormat>()?, LogFormat::RangeBearing);
/// assert_eq!(LogFormat::Utias.to_string(), "utias");
/// assert!("rosbag".parse::<LogFormat>().is_err());
/// # Ok::<(), wayfix_sensor_log::LogError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LogFormat {
    /// A folder of the UTIAS Multi-Robot Cooperative Localization and Mapping set.
    Utias,
    /// A folder of the Victoria Park set: `odometry.csv`, `trees.csv` and optionally `gps.csv`.
    VictoriaPark,
    /// Plain `L`, `P`, `O`, `Z` lines.
    RangeBearing,
    /// A trajectory as the TUM RGB-D benchmark writes it.
    Tum,
    /// Messages of the Carnegie Mellon toolkit, one a line, as the Radish logs have them.
    Carmen,
    /// Scans with their poses as one JSON object, as the raw Intel Lab log is spread.
    ScanJson,
    /// MCAP with Foxglove protobuf messages.
    Mcap,
    /// A folder of PNG and JPEG files, frames by name.
    Images,
}

impl LogFormat {
    /// Every format.
    pub const ALL: [Self; 8] = [
        Self::Utias,
        Self::RangeBearing,
        Self::Tum,
        Self::Mcap,
        Self::Images,
        Self::VictoriaPark,
        Self::Carmen,
        Self::ScanJson,
    ];
    pub(crate) const NAMES: &'static str =
        "utias, range-bearing, tum, mcap, images, victoria-park, carmen, scan-json";

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Utias => "utias",
            Self::VictoriaPark => "victoria-park",
            Self::RangeBearing => "range-bearing",
            Self::Tum => "tum",
            Self::Carmen => "carmen",
            Self::ScanJson => "scan-json",
            Self::Mcap => "mcap",
            Self::Images => "images",
        }
    }

    /// Detects the format at `path`: of folders by their content, of `.mcap` by name, else by the first bytes.
    /// # Errors
    /// Returns an error if the path does not exist, cannot be read, is empty, or has no known format.
    pub fn detect(path: &Path) -> Result<Self, LogError> {
        let io = |source| LogError::io(path, source);
        if fs::metadata(path).map_err(io)?.is_dir() {
            if victoria_park::is_in(path) {
                return Ok(Self::VictoriaPark);
            }
            return match (utias::robots_present(path)?.as_slice(), images_in(path)?.as_slice()) {
                ([], []) if !files_in(path)?.is_empty() => Ok(Self::Mcap),
                ([], []) => {
                    unsupported_format::check_folder(path)?;
                    Err(LogError::IsADirectory { path: path.into() })
                }
                ([], _) => Ok(Self::Images),
                _ => Ok(Self::Utias),
            };
        }
        unsupported_format::check(path)?;
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap")) {
            return Ok(Self::Mcap);
        }
        let mut head = Vec::new();
        let file = File::open(path).map_err(io)?;
        file.take(MAGIC.len() as u64).read_to_end(&mut head).map_err(io)?;
        if head == MAGIC {
            return Ok(Self::Mcap);
        }
        Self::detect_text(open_text(path)?, path)
    }

    fn detect_text(mut text: TextReader, path: &Path) -> Result<Self, LogError> {
        let beginning = text.fill_buf().map_err(|source| LogError::io(path, source))?;
        if beginning.trim_ascii_start().starts_with(b"{") {
            return Ok(Self::ScanJson);
        }
        let mut lines = Lines::new(text, path);
        let mut first = None;
        for _ in 0..ROWS_TRIED {
            let Some(row) = lines.next_row()? else { break };
            match &row.text {
                Ok(text) if range_bearing::looks_like(text) => return Ok(Self::RangeBearing),
                Ok(text) if tum::looks_like(text) => return Ok(Self::Tum),
                Ok(text) if carmen::looks_like(text) => return Ok(Self::Carmen),
                _ => {}
            }
            first.get_or_insert_with(|| match row.text {
                Ok(text) => format!("line {} is {:?}", row.number, shortened(text)),
                Err(error) => format!("line {}: {}", row.number, error.reason),
            });
        }
        match first {
            Some(reason) => Err(LogError::UnknownFormat { path: path.into(), reason }),
            None => Err(LogError::Empty { path: path.into() }),
        }
    }
}

/// Number of rows tested before a text counts as unknown, so that a damaged row or a header does not hide the format.
const ROWS_TRIED: usize = 16;

/// Enough of a text to recognize it in a message.
pub(crate) fn shortened(text: &str) -> String {
    const MAX_CHARS: usize = 40;
    match text.char_indices().nth(MAX_CHARS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

impl fmt::Display for LogFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for LogFormat {
    type Err = LogError;
    fn from_str(name: &str) -> Result<Self, LogError> {
        Self::ALL
            .into_iter()
            .find(|format| format.name() == name)
            .ok_or_else(|| LogError::NoSuchFormat { name: name.to_owned() })
    }
}
