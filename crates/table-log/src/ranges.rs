use std::path::Path;

use nalgebra::Vector2;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{ReadReport, Record, RecordData, RowProblem, RowProblemKind, Stamp, TrueLandmark};

use crate::{RecordingError, columns::Column, table::Table};

/// A recording of ranges to radio beacons: a folder of tables, as of the Plaza sets. [Djugash et al. 2009]
///
/// | file | columns |
/// | --- | --- |
/// | `odometry.csv` | `t_s,distance_m,turn_rad`: since the row before |
/// | `ranges.csv` | `t_s,beacon,range_m` |
/// | `truth.csv`, may be missing | `t_s,x_m,y_m,heading_rad` |
/// | `beacons.csv`, may be missing | `beacon,x_m,y_m`: true places, to compare with |
#[derive(Clone, Debug, Default)]
pub struct RangeRecording {
    /// Motions since the row before, an arc each, in time order.
    pub odometry: Vec<(Stamp, Pose2<f64>)>,
    /// Ranges in time order.
    pub ranges: Vec<BeaconRangeRow>,
    /// True poses and true beacons.
    pub truth: Vec<Record>,
    /// Rows that were left out.
    pub report: ReadReport,
}

/// A row of `ranges.csv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconRangeRow {
    /// When.
    pub stamp: Stamp,
    /// To which beacon.
    pub beacon: u32,
    /// m; may be zero or negative.
    pub range: f64,
}

const ODOMETRY: &str = "odometry.csv";
const RANGES: &str = "ranges.csv";
const TRUTH: &str = "truth.csv";
const BEACONS: &str = "beacons.csv";

impl RangeRecording {
    /// Whether a folder is one: it has a table of ranges.
    pub fn is_in(folder: &Path) -> bool {
        folder.join(RANGES).is_file()
    }

    /// Reads all tables of a folder.
    ///
    /// # Errors
    /// [`RecordingError`] when a table is missing that must be there, has other columns, or no row of use.
    pub fn read(folder: &Path) -> Result<Self, RecordingError> {
        let mut report = ReadReport::default();
        let mut odometry = stamped(&folder.join(ODOMETRY), ["t s", "distance m", "turn rad"], &mut report)?;
        in_time_order(&mut odometry, ODOMETRY, &mut report);
        let mut ranges = stamped(&folder.join(RANGES), ["t s", "beacon", "range m"], &mut report)?;
        in_time_order(&mut ranges, RANGES, &mut report);
        let arc = |(stamp, [distance, turn]): (Stamp, [f64; 2])| {
            (stamp, Pose2::exp(&nalgebra::Vector3::new(distance, 0.0, turn)))
        };
        let (ranges, unknown): (Vec<_>, Vec<_>) =
            ranges.into_iter().partition(|(_, [beacon, _])| identity(*beacon).is_some());
        for (stamp, [beacon, _]) in unknown {
            let reason =
                format!("beacon {beacon} at {stamp} is no identity: it must be a whole number from 0");
            report.add(problem(RANGES, 0, RowProblemKind::NotANumber, reason));
        }
        let row = |(stamp, [beacon, range]): (Stamp, [f64; 2])| {
            Some(BeaconRangeRow { stamp, beacon: identity(beacon)?, range })
        };
        Ok(Self {
            odometry: odometry.into_iter().map(arc).collect(),
            ranges: ranges.into_iter().filter_map(row).collect(),
            truth: truth(folder, &mut report)?,
            report,
        })
    }
}

fn truth(folder: &Path, report: &mut ReadReport) -> Result<Vec<Record>, RecordingError> {
    let (poses, beacons) = (folder.join(TRUTH), folder.join(BEACONS));
    let mut records = Vec::new();
    if beacons.is_file() {
        for [id, x, y] in read_rows(&beacons, ["beacon", "x m", "y m"], report)? {
            if let Some(id) = identity(id) {
                let data = RecordData::TrueLandmark(TrueLandmark { id, x, y });
                records.push(Record { stamp: Stamp::default(), data });
            }
        }
    }
    if poses.is_file() {
        let mut rows = stamped(&poses, ["t s", "x m", "y m", "heading rad"], report)?;
        in_time_order(&mut rows, TRUTH, report);
        records.extend(rows.into_iter().map(|(stamp, [x, y, heading])| Record {
            stamp,
            data: RecordData::TruePose(Pose2 {
                translation: Vector2::new(x, y),
                ..Pose2::new(0.0, 0.0, heading)
            }),
        }));
    }
    Ok(records)
}

/// Rows whose first column is a time, s.
fn stamped<const N: usize, const M: usize>(
    path: &Path,
    names: [&str; N],
    report: &mut ReadReport,
) -> Result<Vec<(Stamp, [f64; M])>, RecordingError> {
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut rows = Vec::new();
    for row in read_rows(path, names, report)? {
        match Stamp::from_seconds(row[0]) {
            Some(stamp) => rows.push((stamp, std::array::from_fn(|k| row[k + 1]))),
            None => {
                let reason = format!("time {} s is out of range", row[0]);
                report.add(problem(&file, 0, RowProblemKind::BadStamp, reason));
            }
        }
    }
    Ok(rows)
}

fn read_rows<const N: usize>(
    path: &Path,
    names: [&str; N],
    report: &mut ReadReport,
) -> Result<Vec<[f64; N]>, RecordingError> {
    let table = Table::read(path, report)?;
    let refused = |reason| RecordingError::Table { path: path.to_owned(), reason };
    let header = table.names.as_deref().unwrap_or_default();
    if header != names {
        let wanted = names.map(|name| name.replace(' ', "_")).join(",");
        return Err(refused(format!("the first row must be {wanted}")));
    }
    let mut rows = Vec::with_capacity(table.rows.len());
    for (line, cells) in &table.rows {
        let read = || -> Result<[f64; N], String> {
            table.check_width(cells)?;
            let mut row = [0.0; N];
            for (index, value) in row.iter_mut().enumerate() {
                *value = table.number(cells, Column { index, factor: 1.0, unit: "", is_assumed: false })?;
            }
            Ok(row)
        };
        match read() {
            Ok(row) => rows.push(row),
            Err(reason) => table.leave_out(*line, reason, report),
        }
    }
    if rows.is_empty() {
        Err(refused(format!("no row of use; {}", table.first_problem(report))))
    } else {
        Ok(rows)
    }
}

/// Sorts rows by time and says how many came late.
fn in_time_order<T>(rows: &mut [(Stamp, T)], file: &str, report: &mut ReadReport) {
    for (row, pair) in rows.windows(2).enumerate() {
        if pair[1].0 < pair[0].0 {
            let reason = format!("{} comes after {}", pair[1].0, pair[0].0);
            report.add(problem(file, row as u64 + 3, RowProblemKind::OutOfOrder, reason));
        }
    }
    rows.sort_by_key(|(stamp, _)| *stamp);
}

fn identity(number: f64) -> Option<u32> {
    (number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number)).then_some(number as u32)
}

fn problem(file: &str, row: u64, kind: RowProblemKind, reason: String) -> RowProblem {
    RowProblem { file: file.to_owned(), row, kind, reason }
}
