//! The UTIAS Multi-Robot Cooperative Localization and Mapping sets. [Leung et al. 2011]
//!
//! A folder with `Barcodes.dat`, `Landmark_Groundtruth.dat` and `RobotN_{Groundtruth,Odometry,Measurement}.dat`. The header of
//! the measurement file says "subject", its column holds the barcode.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs;
use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{RowError, columns, id, number, stamp};
use super::time_order::{Timed, rows_in_time_order};
use crate::{
    Detection, DetectionTarget, LogError, LogFormat, ReadReport, Record, RecordData, RowProblemKind, Stamp,
    TrueLandmark, Velocity,
};

/// The set's numbering: subjects up to here are robots, the others landmarks.
const LAST_ROBOT_SUBJECT: u32 = 5;

/// The numbers of the robots in a folder, in order.
pub(crate) fn robots_present(folder: &Path) -> Result<Vec<u32>, LogError> {
    let io = |source| LogError::io(folder, source);
    let mut robots = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let name = entry.map_err(io)?.file_name();
        robots.extend(name.to_str().and_then(robot_of_file));
    }
    robots.sort_unstable();
    robots.dedup();
    Ok(robots)
}

fn robot_of_file(name: &str) -> Option<u32> {
    let (number, _) = name.strip_prefix("Robot")?.strip_suffix(".dat")?.split_once('_')?;
    number.parse().ok()
}

/// The requested robot, or the only one.
pub(crate) fn choose_robot(folder: &Path, asked: Option<u32>) -> Result<u32, LogError> {
    if fs::metadata(folder).map_err(|source| LogError::io(folder, source))?.is_file() {
        let reason = "a UTIAS set is a folder; give the folder that holds Barcodes.dat".to_owned();
        return Err(LogError::NotThisFormat { path: folder.into(), format: LogFormat::Utias, reason });
    }
    let present = robots_present(folder)?;
    let path = || folder.to_path_buf();
    match (asked, present.as_slice()) {
        (_, []) => Err(LogError::IsADirectory { path: path() }),
        (Some(robot), _) if present.contains(&robot) => Ok(robot),
        (Some(robot), _) => Err(LogError::NoSuchRobot { path: path(), robot, present }),
        (None, [only]) => Ok(*only),
        (None, _) => Err(LogError::RobotNeeded { path: path(), present }),
    }
}

/// All records of one robot. The two files of true positions may be missing.
pub(crate) fn read(folder: &Path, robot: u32, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let targets = read_barcodes(&folder.join("Barcodes.dat"), report)?;
    let file = |kind| folder.join(format!("Robot{robot}_{kind}.dat"));

    // The stable sort keeps this order at equal stamps: truth, odometry, detections.
    let mut records = optional(read_true_poses(&file("Groundtruth"), report))?;
    records.extend(read_odometry(&file("Odometry"), report)?);
    records.extend(read_detections(&file("Measurement"), &targets, report)?);
    records.sort_by_key(|record| record.stamp);

    let Some(start) = records.first().map(|record| record.stamp) else {
        return Ok(records);
    };
    let landmarks = optional(read_landmarks(&folder.join("Landmark_Groundtruth.dat"), start, report))?;
    records.splice(..0, landmarks);
    Ok(records)
}

fn optional(records: Result<Vec<Record>, LogError>) -> Result<Vec<Record>, LogError> {
    match records {
        Err(LogError::NotFound { .. }) => Ok(Vec::new()),
        result => result,
    }
}

fn read_barcodes(path: &Path, report: &mut ReadReport) -> Result<BTreeMap<u32, DetectionTarget>, LogError> {
    let mut targets = BTreeMap::new();
    Lines::open(path)?.for_each_row(report, |row| {
        let [subject, barcode] = columns(row)?;
        let (subject, barcode) = (id(subject)?, id(barcode)?);
        match targets.entry(barcode) {
            Entry::Occupied(first) => Err(RowError::new(
                RowProblemKind::Inconsistent,
                format!("barcode {barcode} is already that of {:?}", first.get()),
            )),
            Entry::Vacant(slot) => {
                let is_robot = subject <= LAST_ROBOT_SUBJECT;
                slot.insert(if is_robot {
                    DetectionTarget::Robot(subject)
                } else {
                    DetectionTarget::Landmark(subject)
                });
                Ok(())
            }
        }
    })?;
    Ok(targets)
}

fn read_true_poses(path: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    read_stamped(path, report, |[t, x, y, heading]| {
        let pose = Pose2::new(number(x)?, number(y)?, number(heading)?);
        Ok((stamp(t)?, RecordData::TruePose(pose)))
    })
    .map(to_records)
}

fn read_odometry(path: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    read_stamped(path, report, |[t, linear, angular]| {
        let velocity = Velocity { linear: number(linear)?, angular: number(angular)? };
        Ok((stamp(t)?, RecordData::Velocity(velocity)))
    })
    .map(to_records)
}

/// Rows of equal stamp form one scan, in file order.
fn read_detections(
    path: &Path,
    targets: &BTreeMap<u32, DetectionTarget>,
    report: &mut ReadReport,
) -> Result<Vec<Record>, LogError> {
    let detections = read_stamped(path, report, |[t, barcode, range, bearing]| {
        let (stamp, barcode) = (stamp(t)?, id(barcode)?);
        let target = targets.get(&barcode).copied().unwrap_or(DetectionTarget::UnknownCode(barcode));
        Ok((stamp, Detection { target, range: number(range)?, bearing: number(bearing)? }))
    })?;
    let mut scans: BTreeMap<Stamp, Vec<Detection>> = BTreeMap::new();
    for Timed { stamp, item: detection, .. } in detections {
        scans.entry(stamp).or_default().push(detection);
    }
    Ok(scans
        .into_iter()
        .map(|(stamp, detections)| Record { stamp, data: RecordData::Detections(detections) })
        .collect())
}

fn read_landmarks(path: &Path, start: Stamp, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let mut landmarks = Vec::new();
    Lines::open(path)?.for_each_row(report, |row| {
        let [subject, x, y, _, _] = columns(row)?;
        let landmark = TrueLandmark { id: id(subject)?, x: number(x)?, y: number(y)? };
        landmarks.push(Record { stamp: start, data: RecordData::TrueLandmark(landmark) });
        Ok(())
    })?;
    Ok(landmarks)
}

fn to_records(rows: Vec<Timed<RecordData>>) -> Vec<Record> {
    rows.into_iter().map(|Timed { stamp, item: data, .. }| Record { stamp, data }).collect()
}

/// The rows of a file in time order.
fn read_stamped<T, const N: usize>(
    path: &Path,
    report: &mut ReadReport,
    read_row: impl Fn([&str; N]) -> Result<(Stamp, T), RowError>,
) -> Result<Vec<Timed<T>>, LogError> {
    rows_in_time_order(Lines::open(path)?, report, |text| read_row(columns(text)?))
}
