use std::{io, path::PathBuf};

use wayfix_visual_tracking::TrackingError;

/// Errors of following a target.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrackSystemError {
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A text describes no valid box.
    #[error("{text:?} is no box: {reason}")]
    NotABox {
        /// The text.
        text: String,
        /// The reason.
        reason: String,
    },
    /// A line of a box list is invalid.
    #[error("line {line}")]
    Line {
        /// Line number, from 1.
        line: usize,
        /// The reason.
        source: Box<TrackSystemError>,
    },
    /// A file is not a valid mask.
    #[error("{} is no mask: {reason}", path.display())]
    NotAMask {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// The start position of the target is unknown.
    #[error(
        "no frame that could be used has a true box: say with --init where the target is in the first one"
    )]
    NoStart,
    /// The detector has found no head.
    #[error("no head was detected in {n_frames} frames")]
    NoHead {
        /// Frames in which it was searched.
        n_frames: u64,
    },
    /// Pictures with true boxes to learn a detector from have no such picture, or bad ones.
    #[error("cannot learn a head from {}", path.display())]
    Examples {
        /// Folder of the pictures.
        path: PathBuf,
        /// The detector's error.
        source: TrackingError,
    },
    /// No frame is usable.
    #[error("no frame could be used{because}")]
    NoFrame {
        /// The reason of the first refusal, after a colon.
        because: String,
    },
    /// The tracker cannot start with the given target.
    #[error("the tracker cannot begin with the {init} in a frame of {width} x {height} pixels")]
    Start {
        /// The given start.
        init: String,
        /// Width of the first frame.
        width: u32,
        /// Height of the first frame.
        height: u32,
        /// The tracker's error.
        source: TrackingError,
    },
    /// A picture could not be written.
    #[error(transparent)]
    Image(#[from] wayfix_sensor_log::ImageError),
}
