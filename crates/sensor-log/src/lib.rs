//! Stamped robot records: readers for public data sets, MCAP and folders of images, and writers for the same.
//!
//! [`open`] (for a log in several files, [`open_all`]) gives the records of a log of any format in time order, and a [`ReadReport`] of what could not be read:
//! | format | is | holds |
//! | --- | --- | --- |
//! | [`LogFormat::Utias`] | a folder of the UTIAS multi-robot set | velocity, detections, truth |
//! | [`LogFormat::VictoriaPark`] | a folder of the Victoria Park set as CSV | car odometry, trees, GPS |
//! | [`LogFormat::RangeBearing`] | `L`, `P`, `O`, `Z` lines | increments, detections, truth |
//! | [`LogFormat::Tum`] | `t x y z qx qy qz qw` lines | poses |
//! | [`LogFormat::Carmen`] | messages of the Carnegie Mellon toolkit, one a line | scans, increments, the laser's mount, poses that are not the odometry |
//! | [`LogFormat::ScanJson`] | scans with their poses as a JSON object | scans, increments, poses |
//! | [`LogFormat::Mcap`] | MCAP with Foxglove protobuf messages on the [`topics`] | everything |
//! | | MCAP with ROS 2 messages ([`ros`]), as `ros2 bag` writes it | scans, odometry, images, cameras, poses |
//! | [`LogFormat::Images`] | a folder of PNG and JPEG files | images |
//!
//! [`write()`] writes records as text or MCAP, and [`convert()`] a whole log. [`McapWriter`] also writes drawings for viewers ([`FoxgloveMessageWriter`]
//! also to live viewers). [`LogSummary`] summarizes the content of a log.
//!
//! The features `lz4` and `zstd` (on by default) read compressed chunks of MCAP by C libraries. Without them such a chunk counts as damaged, with the reason.
//! [`McapMessageSink::create_compressed`] needs `zstd`.
//!
//! An unusable row never stops the reading: it is skipped and counted by kind, and the first few are reported with file and line.
//! ```
//! use wayfix_sensor_log::{RecordData, LogOpenOptions, open};
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("walk.txt");
//! std::fs::write(&path, "L 7 2.0 0.0\nO 0.5 0.0 0.0\nZ 7 1.5 0.0\nZ 7 far 0.0\n")?;
//! let mut log = open(&path, &LogOpenOptions::default())?;
//! let detections = log.by_ref().filter(|record| matches!(record.data, RecordData::Detections(_))).count();
//! assert_eq!(detections, 1);
//! assert_eq!(log.report().n_problems(), 1); // line 4: "far" is not a number
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ackermann;
mod bag;
mod cdr;
mod convert;
mod error;
mod fault;
mod formats;
mod image_folder;
mod log;
mod mcap_log;
mod open;
mod planar;
mod pose_measurement;
mod record;
mod report;
pub mod ros;
mod scan;
mod stamp;
mod summary;
mod text;
mod write;

pub use ackermann::AckermannDrive;
pub use bag::{BagTopic, TopicUse};
pub use convert::convert;
pub use error::LogError;
pub use formats::compressed::read_text;
pub use formats::format::LogFormat;
pub use image_folder::{image_files, is_hidden};
pub use log::{Log, LogMetadata};
pub use mcap_log::{
    ChannelKey, DrawingShape, FoxgloveMessage, FoxgloveMessageSink, FoxgloveMessageWriter, ImageOutline,
    McapMessageSink, McapWriter, MessageSinks, ViewerDrawing, topics,
};
pub use open::{LogOpenOptions, PoseKind, open, open_all};
pub use pose_measurement::{MeasuredQuantity, PoseMeasurement};
pub use record::{
    CameraInfo, Detection, DetectionTarget, Record, RecordData, TrueLandmark, TruePosition, TrueWall,
    Velocity,
};
pub use report::{LogCompleteness, LogWarning, ReadReport, RowProblem, RowProblemKind};
pub use scan::{LaserScan, LogScanStatistics};
pub use stamp::Stamp;
pub use summary::{LogSummary, RecordKindSummary};
pub use text::{PoseRelation, read_relations};
pub use wayfix_encoded_image::{
    DecodedImage, EncodedImage, ImageError, ImageFileFormat, LogImageStatistics, PixelLayout,
};
pub use write::{WriteReport, write};
