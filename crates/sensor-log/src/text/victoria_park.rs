//! The Victoria Park set of the Australian Centre for Field Robotics [Guivant & Nebot 2001], as CSV files in a folder.
//!
//! | file | columns (the first row names them) |
//! | --- | --- |
//! | `odometry.csv` | `t_s,speed_mps,steering_rad`: the encoder of the rear left wheel and the steering |
//! | `trees.csv` | `t_s,range_m,bearing_rad,diameter_m`: trunks in the laser scans; bearing 0 to the right, π/2 ahead; an optional fifth column `landmark` identifies the tree; it is empty for an unknown tree |
//! | `gps.csv` | `t_s,x_m,y_m`: fixes of the antenna, which are the truth; a fourth column `sigma_m`, which may be there, makes a fix a measurement with this standard deviation where it is not empty; the file may be missing |
//!
//! Bearings follow REP 103, 0 ahead, and are relative to the laser, which is 3.78 m ahead of the rear axle and 0.5 m left.

use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::{Matrix3, Vector2, Vector3};
use wayfix_estimation_traits::wrap_angle;

use super::Lines;
use super::gps::drop_jumps;
use super::row::{RowError, comma_columns, id, number, stamp, standard_deviation};
use super::time_order::{Timed, rows_in_time_order};
use crate::formats::format::shortened;
use crate::topics::WORLD_FRAME;
use crate::{
    AckermannDrive, Detection, DetectionTarget, LogError, LogFormat, MeasuredQuantity, PoseMeasurement,
    ReadReport, Record, RecordData, Stamp, TruePosition,
};

const ODOMETRY: &str = "odometry.csv";
const TREES: &str = "trees.csv";
const GPS: &str = "gps.csv";

/// Whether the folder contains the set.
pub(crate) fn is_in(folder: &Path) -> bool {
    [ODOMETRY, TREES].iter().all(|name| folder.join(name).is_file())
}

/// All records, sorted by time.
pub(crate) fn read(folder: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    if folder.is_file() {
        let reason = format!("the set is a folder; give the one that holds {ODOMETRY} and {TREES}");
        return Err(LogError::NotThisFormat { path: folder.into(), format: LogFormat::VictoriaPark, reason });
    }
    // The stable sort keeps this order at equal stamps: truth, odometry, detections.
    let mut records = read_fixes(&folder.join(GPS), report)?;
    records.extend(read_odometry(&folder.join(ODOMETRY), report)?);
    records.extend(read_trees(&folder.join(TREES), report)?);
    records.sort_by_key(|record| record.stamp);
    Ok(records)
}

fn read_odometry(path: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let header = ["t_s", "speed_mps", "steering_rad"];
    let rows = read_rows(path, header, report, |[t, speed, steering]| {
        let drive = AckermannDrive { wheel_speed: number(speed)?, steering: number(steering)? };
        Ok((stamp(t)?, drive))
    })?;
    let to_record = |Timed { stamp, item, .. }| Record { stamp, data: RecordData::Ackermann(item) };
    Ok(rows.into_iter().map(to_record).collect())
}

/// Rows of equal stamp form one scan, in file order.
fn read_trees(path: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let take = |[t, range, bearing, diameter]: [&str; 4], target: DetectionTarget| {
        let (stamp, range, width) = (stamp(t)?, number(range)?, number(diameter)?);
        let bearing = wrap_angle(number(bearing)? - std::f64::consts::FRAC_PI_2);
        Ok((stamp, (width, Detection { target, range, bearing })))
    };
    let trees = if has_columns::<5>(path)? {
        let header = ["t_s", "range_m", "bearing_rad", "diameter_m", "landmark"];
        read_rows(path, header, report, |[t, range, bearing, diameter, landmark]| {
            let target = if landmark.is_empty() {
                DetectionTarget::Unlabelled
            } else {
                DetectionTarget::Landmark(id(landmark)?)
            };
            take([t, range, bearing, diameter], target)
        })?
    } else {
        let header = ["t_s", "range_m", "bearing_rad", "diameter_m"];
        read_rows(path, header, report, |row| take(row, DetectionTarget::Unlabelled))?
    };
    let mut scans: BTreeMap<Stamp, (Vec<f64>, Vec<Detection>)> = BTreeMap::new();
    for Timed { stamp, item: (width, detection), .. } in trees {
        let (widths, detections) = scans.entry(stamp).or_default();
        widths.push(width);
        detections.push(detection);
    }
    let to_records = |(stamp, (widths, detections))| {
        [RecordData::DetectionWidths(widths), RecordData::Detections(detections)]
            .map(|data| Record { stamp, data })
    };
    Ok(scans.into_iter().flat_map(to_records).collect())
}

/// Whether the header has this many columns.
fn has_columns<const N: usize>(path: &Path) -> Result<bool, LogError> {
    let mut lines = Lines::open(path)?;
    let header = lines.next_row()?;
    Ok(header.and_then(|row| row.text.ok()).is_some_and(|text| comma_columns::<N>(text).is_ok()))
}

fn read_fixes(path: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let take = |[t, x, y]: [&str; 3], sigma: Option<f64>| {
        Ok((stamp(t)?, (TruePosition { x: number(x)?, y: number(y)? }, sigma)))
    };
    let read = match has_columns::<4>(path) {
        Err(LogError::NotFound { .. }) => return Ok(Vec::new()),
        Ok(true) => read_rows(path, ["t_s", "x_m", "y_m", "sigma_m"], report, |[t, x, y, sigma]| {
            let sigma = if sigma.is_empty() { None } else { Some(standard_deviation(sigma)?) };
            take([t, x, y], sigma)
        }),
        _ => read_rows(path, ["t_s", "x_m", "y_m"], report, |row| take(row, None)),
    };
    let (mut fixes, mut records) = (Vec::new(), Vec::new());
    for Timed { row, stamp, item: (position, sigma) } in read? {
        match sigma {
            None => fixes.push((row, stamp, position)),
            Some(sigma) => records.push(Record { stamp, data: measured(&position, sigma) }),
        }
    }
    let to_record = |(stamp, position)| Record { stamp, data: RecordData::TruePosition(position) };
    records.extend(drop_jumps(GPS, fixes, report).into_iter().map(to_record));
    Ok(records)
}

/// A fix that corrects the robot.
fn measured(position: &TruePosition, sigma: f64) -> RecordData {
    let variance = Vector3::new(sigma * sigma, sigma * sigma, 0.0);
    RecordData::PoseMeasurement(PoseMeasurement {
        frame: WORLD_FRAME.to_owned(),
        quantity: MeasuredQuantity::Position(Vector2::new(position.x, position.y)),
        covariance: Some(Matrix3::from_diagonal(&variance)),
    })
}

/// The rows below the header in time order.
fn read_rows<T, const N: usize>(
    path: &Path,
    header: [&str; N],
    report: &mut ReadReport,
    mut read_row: impl FnMut([&str; N]) -> Result<(Stamp, T), RowError>,
) -> Result<Vec<Timed<T>>, LogError> {
    let mut lines = Lines::open(path)?;
    check_header(&mut lines, path, header)?;
    rows_in_time_order(lines, report, |text| read_row(comma_columns(text)?))
}

/// Rejects unexpected columns, which would give a plausible but wrong log.
fn check_header<R: std::io::BufRead, const N: usize>(
    lines: &mut Lines<R>,
    path: &Path,
    header: [&str; N],
) -> Result<(), LogError> {
    let Some(row) = lines.next_row()? else {
        return Err(LogError::Empty { path: path.into() });
    };
    let text = row.text.unwrap_or("no text");
    if comma_columns(text).is_ok_and(|columns: [&str; N]| columns == header) {
        return Ok(());
    }
    let reason = format!("line {} is {:?} instead of {:?}", row.number, shortened(text), header.join(","));
    Err(LogError::NotThisFormat { path: path.into(), format: LogFormat::VictoriaPark, reason })
}
