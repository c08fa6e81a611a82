use std::io;
use std::path::{Path, PathBuf};

use wayfix_estimation_traits::Pose2;

use crate::image_folder::ImageFolder;
use crate::log::Records;
use crate::mcap_log::{McapRecords, files_of};
use crate::text::{carmen, range_bearing, scan_json, tum, utias, victoria_park};
use crate::{
    Log, LogCompleteness, LogError, LogFormat, LogMetadata, LogWarning, ReadReport, Record, RecordData,
};

/// Options for opening a log. The default detects all of them.
#[derive(Clone, Debug)]
pub struct LogOpenOptions {
    /// The format; `None` detects it.
    pub format: Option<LogFormat>,
    /// Which robot, in sets of several.
    pub robot: Option<u32>,
    /// Meaning of the poses in a format that does not define it (TUM, CARMEN, JSON).
    pub poses: PoseKind,
    /// Topics of a ROS 2 bag to read. For a kind without a topic in this list, the topic with the most messages is read.
    pub topics: Vec<String>,
    /// Frames a second of a folder of images, which has no clock: frame k is k / rate seconds after the start. 30 Hz by default.
    pub frame_rate_hz: f64,
}

impl Default for LogOpenOptions {
    fn default() -> Self {
        Self {
            format: None,
            robot: None,
            poses: PoseKind::default(),
            topics: Vec::new(),
            frame_rate_hz: 30.0,
        }
    }
}

/// Meaning of bare poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum PoseKind {
    /// Some program's estimate: [`RecordData::EstimatedPose`](crate::RecordData::EstimatedPose).
    #[default]
    Estimated,
    /// The truth: [`RecordData::TruePose`](crate::RecordData::TruePose).
    True,
}

impl PoseKind {
    pub(crate) fn data(self, pose: Pose2<f64>) -> RecordData {
        match self {
            Self::Estimated => RecordData::EstimatedPose(pose),
            Self::True => RecordData::TruePose(pose),
        }
    }
}

/// Opens the log at `path`.
///
/// Records come in time order; at equal stamps true landmarks first, then true pose, odometry, detections (MCAP: file order). Every repair below is reported.
///
/// Text logs are read completely and sorted if rows go backwards. A row a minute or more from its neighbours is skipped; if the clock is set back,
/// the longest stretch is read. CARMEN logs are read line by line, twice, and keep their order: repeated stamps are replaced, and stamps after a
/// clock set back are moved on. Text may be gzipped under any name, begin with a byte-order mark, and have any line ends.
///
/// MCAP files are read chunk by chunk; a record more than 256 records late is skipped. A folder with one MCAP file stands for that file. A folder
/// with files named like the parts of a recording, `NAME_0.mcap`, `NAME_1.mcap`, or listed in its `metadata.yaml`, stands for all of them. In ROS 2
/// bags each kind of record comes from one topic, see [`LogOpenOptions::topics`]; [`LogMetadata::topics`] lists the use of the others.
///
/// Folders of images are read file by file, in the order of their names with numbers by value (`frame9` before `frame10`); other files are
/// skipped. An unreadable file keeps its frame number, so that later stamps stay correct.
/// # Errors
/// Returns an error if the log is unusable: see [`LogError`]. Single bad rows are no error; [`Log::report`] lists them.
pub fn open(path: impl AsRef<Path>, options: &LogOpenOptions) -> Result<Log, LogError> {
    let path = path.as_ref();
    let format = match options.format {
        Some(format) => format,
        None => LogFormat::detect(path)?,
    };
    let (files, warnings) = if format == LogFormat::Mcap { files_of(path)? } else { Default::default() };
    open_files(path, format, files, warnings, options)
}

/// Opens a log recorded in several MCAP files, given in any order; all messages come in time order.
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{RecordData, LogFormat, LogOpenOptions, Record, Stamp, open_all, write};
/// # let folder = tempfile::tempdir()?;
/// # let (first, second) = (folder.path().join("drive_0.mcap"), folder.path().join("drive_1.mcap"));
/// let at = |second: u64| Record { stamp: Stamp::from_nanoseconds(second), data: RecordData::TruePose(Pose2::new(1.0, 2.0, 0.3)) };
/// write(&first, LogFormat::Mcap, [at(1), at(2)])?;
/// write(&second, LogFormat::Mcap, [at(3)])?;
/// let (records, _) = open_all(&[second, first], &LogOpenOptions::default())?.read_all();
/// assert_eq!(records, [at(1), at(2), at(3)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns [`LogError::NotAPart`], [`LogError::NoPath`], or the errors of [`open`], which handles a single path.
pub fn open_all(paths: &[impl AsRef<Path>], options: &LogOpenOptions) -> Result<Log, LogError> {
    if let [path] = paths {
        return open(path, options);
    }
    let first = paths.first().ok_or(LogError::NoPath)?.as_ref();
    let (mut files, mut warnings) = (Vec::new(), Vec::new());
    for path in paths.iter().map(AsRef::as_ref) {
        let format = options.format.map_or_else(|| LogFormat::detect(path), Ok)?;
        if format != LogFormat::Mcap {
            return Err(LogError::NotAPart { path: path.into(), format });
        }
        let (found, doubts) = files_of(path)?;
        files.extend(found);
        warnings.extend(doubts);
    }
    open_files(first, LogFormat::Mcap, files, warnings, options)
}

fn open_files(
    source: &Path,
    format: LogFormat,
    files: Vec<PathBuf>,
    warnings: Vec<LogWarning>,
    options: &LogOpenOptions,
) -> Result<Log, LogError> {
    // A folder with one file is that file.
    let path = if let [file] = files.as_slice() { file.clone() } else { source.into() };
    let path = path.as_path();
    if !(path.is_file() || path.is_dir()) && path.exists() {
        let twice = "a pipe is read only once, a log more often: write it to a file";
        return Err(LogError::io(path, io::Error::new(io::ErrorKind::Unsupported, twice)));
    }
    if format != LogFormat::Mcap && !options.topics.is_empty() {
        return Err(LogError::NoTopics { path: path.into(), format });
    }
    let mut meta =
        LogMetadata { format, origin: None, source: path.into(), files, robot: None, topics: Vec::new() };
    let mut report = ReadReport { warnings, ..ReadReport::default() };
    let in_memory = |records: Vec<Record>| Records::Memory(records.into_iter());
    let mut records = match format {
        LogFormat::Utias => {
            let robot = utias::choose_robot(path, options.robot)?;
            meta.robot = Some(robot);
            in_memory(utias::read(path, robot, &mut report)?)
        }
        LogFormat::VictoriaPark => in_memory(victoria_park::read(path, &mut report)?),
        LogFormat::RangeBearing => in_memory(range_bearing::read(path, &mut report)?),
        LogFormat::Tum => in_memory(tum::read(path, options.poses, &mut report)?),
        LogFormat::Carmen => {
            Records::Carmen(Box::new(carmen::CarmenLog::open(path, options.poses, &mut report)?))
        }
        LogFormat::ScanJson => in_memory(scan_json::read(path, options.poses, &mut report)?),
        LogFormat::Mcap => {
            Records::Mcap(Box::new(McapRecords::open(path, &meta.files, &options.topics, &mut report)?))
        }
        LogFormat::Images => Records::Images(ImageFolder::open(path, options.frame_rate_hz)?),
    };
    let first = records.next(&mut report).ok_or_else(|| nothing_in(path, format, &report))?;
    if let Records::Mcap(records) = &records {
        meta.origin = records.origin();
        meta.topics = records.topics().to_vec();
    }
    Ok(Log::new(meta, first, records, report))
}

/// Reason for the absence of records: damage, wrong content, or an empty log.
fn nothing_in(path: &Path, format: LogFormat, report: &ReadReport) -> LogError {
    let path = path.to_path_buf();
    if report.end != LogCompleteness::Complete {
        LogError::Damaged { path, end: report.end.clone() }
    } else if let Some(problem) = report.examples.first() {
        LogError::NotThisFormat { path, format, reason: problem.to_string() }
    } else if !report.ignored.is_empty() {
        LogError::NoKnownTopic { path, ignored: report.ignored.keys().cloned().collect() }
    } else {
        LogError::Empty { path }
    }
}
