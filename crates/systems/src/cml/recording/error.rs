use std::{io, path::PathBuf};

use wayfix_sensor_log::LogError;

/// Why a folder of frames and a table of poses make no recording.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The operating system refuses.
    #[error("{}", path.display())]
    Io {
        /// What was read.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The folder cannot be read.
    #[error(transparent)]
    Folder(#[from] LogError),
    /// There is nothing to read.
    #[error("{}: no {what}", path.display())]
    Nothing {
        /// Where.
        path: PathBuf,
        /// Of what.
        what: &'static str,
    },
    /// A table cannot be understood.
    #[error("{}: {reason}", path.display())]
    Table {
        /// Which one.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// Frames and poses cannot be brought together.
    #[error("{n_frames} frames and {n_poses} poses: {reason}")]
    Unmatched {
        /// Frames in the folder.
        n_frames: usize,
        /// Rows of the table.
        n_poses: usize,
        /// What is missing.
        reason: &'static str,
    },
}
