use std::{io, path::PathBuf};

use wayfix_visual_tracking::TrackingError;

/// Why a target cannot be followed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrackError {
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A text does not say where a box is.
    #[error("{text:?} is no box: {reason}")]
    NotABox {
        /// The text.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A line of a list of boxes is not usable.
    #[error("line {line}")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        source: Box<TrackError>,
    },
    /// A file is not usable as a mask.
    #[error("{} is no mask: {reason}", path.display())]
    NotAMask {
        /// Which one.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// Nobody says where the target is at the beginning.
    #[error(
        "no frame that could be used has a true box: say with --init where the target is in the first one"
    )]
    NoStart,
    /// Not a single frame could be used.
    #[error("no frame could be used{because}")]
    NoFrame {
        /// What the first one was refused for, after a colon.
        because: String,
    },
    /// The tracker cannot begin with what it was given.
    #[error("the tracker cannot begin with the {init} in a frame of {width} x {height} pixels")]
    Start {
        /// What it was given.
        init: String,
        /// Of the first frame.
        width: u32,
        /// Of the first frame.
        height: u32,
        /// What the tracker says.
        source: TrackingError,
    },
    /// A picture could not be written.
    #[error(transparent)]
    Image(#[from] wayfix_sensor_log::ImageError),
}
