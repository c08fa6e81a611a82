use std::io;
use std::path::{Path, PathBuf};

use crate::{ImageFileFormat, LogCompleteness, LogFormat, Stamp};

/// Errors of opening and writing logs, with remedies.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The path does not exist.
    #[error("{}: no such file or folder", path.display())]
    NotFound {
        /// The path.
        path: PathBuf,
    },
    /// An operating-system error.
    #[error("{}: cannot be read or written", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// The operating-system error.
        source: io::Error,
    },
    /// A file cannot be created.
    #[error("{}: cannot be written", path.display())]
    NotCreated {
        /// The file.
        path: PathBuf,
        /// The operating-system error.
        source: io::Error,
    },
    /// The output would overwrite the input log.
    #[error("{}: is the log that is being read; write to another file", path.display())]
    SameFile {
        /// The file.
        path: PathBuf,
    },
    /// A folder that is no log.
    #[error("{}: is a folder without RobotN_*.dat files, without odometry.csv and trees.csv and without MCAP, PNG or JPEG files; give a log file, the folder of a UTIAS set or of images, of a ROS 2 bag, or that of the Victoria Park set", path.display())]
    IsADirectory {
        /// The folder.
        path: PathBuf,
    },
    /// A folder of several MCAP files that do not form one recording.
    #[error("{}: holds {} MCAP files that are not called like the parts of one recording; give one of them, or name those that belong together", path.display(), files.len())]
    SeveralFiles {
        /// The folder.
        path: PathBuf,
        /// The files, by name.
        files: Vec<PathBuf>,
    },
    /// A log of several files, one of which is not MCAP.
    #[error("{}: a {format} log is read alone; only MCAP files can be parts of one log", path.display())]
    NotAPart {
        /// The file or folder.
        path: PathBuf,
        /// Its format.
        format: LogFormat,
    },
    /// No path was given.
    #[error("no log was given")]
    NoPath,
    /// A text in UTF-16, which editors on Windows write; all text formats are UTF-8.
    #[error("{}: is UTF-16 text; `iconv -f UTF-16 -t UTF-8` makes UTF-8 of it", path.display())]
    Utf16 {
        /// The file.
        path: PathBuf,
    },
    /// The content has no known format.
    #[error("{}: not a known log format ({reason}); name the format: {}", path.display(), LogFormat::NAMES)]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What was found instead.
        reason: String,
    },
    /// The content does not match the requested format or the file name.
    #[error("{}: is no log of the format {format}: {reason}", path.display())]
    NotThisFormat {
        /// The file or folder.
        path: PathBuf,
        /// The format it should have.
        format: LogFormat,
        /// The reason.
        reason: String,
    },
    /// A format that other programs turn into one that is read.
    #[error("{}: is {what}, which is not read; {remedy}", path.display())]
    UnsupportedFormat {
        /// The file.
        path: PathBuf,
        /// Name of the format.
        what: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// A data set of several robots needs a choice.
    #[error("{}: holds the robots {present:?}; choose one (--robot N)", path.display())]
    RobotNeeded {
        /// The folder.
        path: PathBuf,
        /// The robots that are there.
        present: Vec<u32>,
    },
    /// The chosen robot is not in the set.
    #[error("{}: has no robot {robot}; it holds the robots {present:?}", path.display())]
    NoSuchRobot {
        /// The folder.
        path: PathBuf,
        /// The robot that was chosen.
        robot: u32,
        /// The robots that are there.
        present: Vec<u32>,
    },
    /// The right format, and no record in it.
    #[error("{}: holds no record", path.display())]
    Empty {
        /// The file or folder.
        path: PathBuf,
    },
    /// An MCAP file in which no message has a topic and schema that this crate reads.
    #[error("{}: no message on a known topic; it has {}", path.display(), ignored.join(", "))]
    NoKnownTopic {
        /// The file.
        path: PathBuf,
        /// Topics and schemas that are there.
        ignored: Vec<String>,
    },
    /// A requested topic does not exist, or holds nothing that is read.
    #[error("{}: nothing that is read on the topic {topic:?}; the topics of the file are {}", path.display(), listed(present))]
    NoSuchTopic {
        /// The file.
        path: PathBuf,
        /// The requested topic.
        topic: String,
        /// Topics and schemas that are there.
        present: Vec<String>,
    },
    /// Two requested topics are of one kind: their records could not be distinguished.
    #[error("{}: {first} and {second} are both {what}; choose one of them", path.display())]
    AmbiguousTopics {
        /// The file.
        path: PathBuf,
        /// The kind.
        what: &'static str,
        /// The topic requested first.
        first: String,
        /// The other one.
        second: String,
    },
    /// Topics were requested for a format that has none.
    #[error("{}: {format} logs have no topics to choose from", path.display())]
    NoTopics {
        /// The file or folder.
        path: PathBuf,
        /// Its format.
        format: LogFormat,
    },
    /// The file is damaged or truncated before the first record.
    #[error("{}: {end} before the first record", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// How it ends.
        end: LogCompleteness,
    },
    /// A format that is read only.
    #[error("{format} logs are read, not written; write one of range-bearing, tum, mcap")]
    NotWritable {
        /// The format.
        format: LogFormat,
    },
    /// A number that no log should hold.
    #[error("{what} at {stamp} is not finite")]
    NotFinite {
        /// Kind of the record.
        what: &'static str,
        /// Its stamp.
        stamp: Stamp,
    },
    /// A camera with an invalid projection.
    #[error("camera at {stamp}: {width} x {height} pixels with focal lengths {fx} and {fy} see nothing")]
    BadCamera {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Horizontal focal length, pixels.
        fx: f64,
        /// Vertical focal length, pixels.
        fy: f64,
        /// Stamp of the record.
        stamp: Stamp,
    },
    /// Bytes that are no image of the stated format, or uncompressed true labels.
    #[error("{what} at {stamp}: {n_bytes} bytes cannot be written as a {} image", format.name())]
    NotAnImage {
        /// Kind of the record.
        what: &'static str,
        /// The expected compression.
        format: ImageFileFormat,
        /// Number of bytes.
        n_bytes: usize,
        /// Stamp of the record.
        stamp: Stamp,
    },
    /// A rate at which no folder of images can be read.
    #[error("frame rate {rate_hz} Hz is not between 0.001 and 1 000 000")]
    BadFrameRate {
        /// The rate.
        rate_hz: f64,
    },
    /// A stamp outside the range of Foxglove messages.
    #[error("stamp {stamp} is beyond the year 2106")]
    StampTooLate {
        /// The stamp.
        stamp: Stamp,
    },
    /// Writing an MCAP file failed.
    #[error("MCAP output: {0}")]
    McapOutput(Box<mcap::McapError>),
    /// A [`FoxgloveMessageSink`](crate::FoxgloveMessageSink) of the caller's own failed.
    #[error("messages cannot be passed on: {0}")]
    Sink(Box<dyn std::error::Error + Send + Sync>),
    /// A name that is no format.
    #[error("{name:?} is no log format; the formats are {}", LogFormat::NAMES)]
    NoSuchFormat {
        /// The name.
        name: String,
    },
}

impl LogError {
    pub(crate) fn io(path: &Path, source: io::Error) -> Self {
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path: path.into() },
            io::ErrorKind::IsADirectory => Self::IsADirectory { path: path.into() },
            _ => Self::Io { path: path.into(), source },
        }
    }
}

fn listed(topics: &[String]) -> String {
    if topics.is_empty() { "none".to_owned() } else { topics.join(", ") }
}

impl From<mcap::McapError> for LogError {
    fn from(error: mcap::McapError) -> Self {
        Self::McapOutput(Box::new(error))
    }
}
