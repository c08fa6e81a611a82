use std::{io, path::PathBuf};

use wayfix_slam_ekf::SlamError;
use wayfix_slam_smoother::SlamSmootherError;

/// Why a saved map could not be written, or cannot be gone on with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SavedMapError {
    /// The operating system refuses.
    #[error("{}", path.display())]
    Io {
        /// What was read or written.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// It does not begin as saved maps do.
    #[error("not a saved map: it does not begin with WAYFIXSM")]
    NotASavedMap,
    /// Another version of the program wrote it.
    #[error("written in version {found} of the format; this program reads version {known}")]
    Version {
        /// The version in the file.
        found: u32,
        /// The version that can be read.
        known: u32,
    },
    /// It ends too early, or has bytes after its end.
    #[error("damaged: {found} bytes in place of {expected}")]
    Length {
        /// The number in the header, or the least number.
        expected: u64,
        /// What is there.
        found: u64,
    },
    /// Its content is not what was written.
    #[error("damaged: the checksum is {found:08x}, not {expected:08x}")]
    Checksum {
        /// The checksum in the header.
        expected: u32,
        /// That of the content.
        found: u32,
    },
    /// The checksum holds and yet the content is not a map: another program made it.
    #[error("not to be decoded: {0}")]
    Payload(postcard::Error),
    /// It is of another kind of robot, landmark or association.
    #[error("a map of another kind: {what} is {found}, here it is {expected}")]
    Kind {
        /// What differs.
        what: &'static str,
        /// As it is here.
        expected: String,
        /// As it is in the map.
        found: String,
    },
    /// The filter refuses what the map holds.
    #[error("not a state of the filter: {0}")]
    State(#[from] SlamError),
    /// The smoother refuses to start from it.
    #[error("not a start of the smoother: {0}")]
    Start(#[from] SlamSmootherError),
}
