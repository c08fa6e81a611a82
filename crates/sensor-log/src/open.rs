use std::path::Path;

use crate::text::{range_bearing, tum, utias};
use crate::{Format, Log, LogError, LogMeta, ReadReport};

/// How to open a log. The default finds out what it can.
#[derive(Clone, Debug, Default)]
pub struct OpenOptions {
    /// The format, when it is not to be detected.
    pub format: Option<Format>,
    /// Which robot, in sets of several.
    pub robot: Option<u32>,
    /// What the poses of a format that does not say (TUM) are.
    pub poses: PoseKind,
}

/// What a bare trajectory means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum PoseKind {
    /// Some program's estimate: [`Data::EstimatedPose`](crate::Data::EstimatedPose).
    #[default]
    Estimated,
    /// The truth: [`Data::TruePose`](crate::Data::TruePose).
    True,
}

/// Opens the log at `path`.
///
/// Records come in time order; at equal stamps true landmarks first, then true pose, odometry, sightings.
/// Text logs are read whole and sorted where rows go backwards (which is reported).
///
/// # Errors
/// When nothing usable is there: see [`LogError`]. Single bad rows are no error, they are in [`Log::report`].
pub fn open(path: impl AsRef<Path>, options: &OpenOptions) -> Result<Log, LogError> {
    let path = path.as_ref();
    let format = match options.format {
        Some(format) => format,
        None => Format::detect(path)?,
    };
    let mut meta = LogMeta { format, source: path.into(), robot: None };
    let mut report = ReadReport::default();
    let records = match format {
        Format::Utias => {
            let robot = utias::choose_robot(path, options.robot)?;
            meta.robot = Some(robot);
            utias::read(path, robot, &mut report)?
        }
        Format::RangeBearing => range_bearing::read(path, &mut report)?,
        Format::Tum => tum::read(path, options.poses, &mut report)?,
        Format::Mcap => {
            let reason = "MCAP is not read yet".to_owned();
            return Err(LogError::NotThisFormat { path: path.into(), format, reason });
        }
    };
    if records.is_empty() {
        return Err(nothing_in(path, format, &report));
    }
    Ok(Log::in_memory(meta, records, report))
}

/// Nothing but bad rows means the wrong format, no rows at all an empty log.
fn nothing_in(path: &Path, format: Format, report: &ReadReport) -> LogError {
    match report.examples.first() {
        Some(problem) => LogError::NotThisFormat { path: path.into(), format, reason: problem.to_string() },
        None => LogError::Empty { path: path.into() },
    }
}
