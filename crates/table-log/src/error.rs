use std::{io, path::PathBuf};

use wayfix_sensor_log::LogError;

/// Errors of combining a folder of frames with a table of poses.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// An operating-system error.
    #[error("{}", path.display())]
    Io {
        /// Path that was read.
        path: PathBuf,
        /// The operating-system error.
        source: io::Error,
    },
    /// The folder cannot be read.
    #[error(transparent)]
    Folder(#[from] LogError),
    /// There is nothing to read.
    #[error("{}: no {what}", path.display())]
    Nothing {
        /// The path.
        path: PathBuf,
        /// The kind of input that is missing.
        what: &'static str,
    },
    /// A table cannot be parsed.
    #[error("{}: {reason}", path.display())]
    Table {
        /// Path of the table.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// Frames and poses cannot be matched.
    #[error("{n_frames} frames and {n_poses} poses: {reason}")]
    Unmatched {
        /// Frames in the folder.
        n_frames: usize,
        /// Rows of the table.
        n_poses: usize,
        /// The reason.
        reason: &'static str,
    },
}
