use std::str::SplitAsciiWhitespace;

use wayfix_estimation_traits::Pose2;

use super::half_circle::half_circle;
use super::row::{RowError, columns, number, range};
use crate::format::shortened;
use crate::{LaserScan, ProblemKind};

/// First words of messages that the Carnegie Mellon toolkit logs and this crate has no use for; some carry the number of a device.
const OTHER_WORDS: [&str; 8] =
    ["PARAM", "SYNC", "NEFF", "RLASER", "TRUEPOS", "LASER", "RAWLASER", "ROBOTLASER"];

/// Columns of a `FLASER` line besides the ranges: the word, their number, two poses, time, host and time.
const SCAN_COLUMNS: usize = 11;

/// A line of a CARMEN log.
pub(super) enum CarmenRow {
    Scan(ScanRow),
    Odometry {
        seconds: f64,
        pose: Pose2<f64>,
    },
    /// A message that is not read: its first word.
    Other(String),
}

/// A `FLASER` line.
pub(super) struct ScanRow {
    pub(super) seconds: f64,
    pub(super) scan: LaserScan,
    /// Where the laser is, corrected if the log is.
    pub(super) pose: Pose2<f64>,
    pub(super) odometry: Pose2<f64>,
}

pub(super) fn parse(row: &str) -> Result<CarmenRow, RowError> {
    let mut rest = row.split_ascii_whitespace();
    match rest.next().unwrap_or_default() {
        "FLASER" => Ok(CarmenRow::Scan(scan_row(row, rest)?)),
        "ODOM" => {
            let [_, x, y, heading, _, _, _, seconds, _, _] = columns(row)?;
            Ok(CarmenRow::Odometry { seconds: number(seconds)?, pose: pose([x, y, heading])? })
        }
        word if OTHER_WORDS.contains(&word.trim_end_matches(|c: char| c.is_ascii_digit())) => {
            Ok(CarmenRow::Other(word.to_owned()))
        }
        word => {
            let reason = format!("{:?} is no message of CARMEN", shortened(word));
            Err(RowError::new(ProblemKind::Unrecognized, reason))
        }
    }
}

fn scan_row(row: &str, mut rest: SplitAsciiWhitespace<'_>) -> Result<ScanRow, RowError> {
    let n_columns = row.split_ascii_whitespace().count();
    let n_beams = number(rest.next().unwrap_or_default())?;
    let n_expected = n_beams + SCAN_COLUMNS as f64;
    if n_columns as f64 != n_expected {
        let reason = format!("{n_columns} columns instead of {n_expected} for {n_beams} beams");
        return Err(RowError::new(ProblemKind::ColumnCount, reason));
    }
    let ranges: Result<Vec<f64>, RowError> =
        rest.by_ref().take(n_columns - SCAN_COLUMNS).map(range).collect();
    let scan = half_circle(ranges?)?;
    let mut triple = || pose([(); 3].map(|()| rest.next().unwrap_or_default()));
    let (pose, odometry) = (triple()?, triple()?);
    Ok(ScanRow { seconds: number(rest.next().unwrap_or_default())?, scan, pose, odometry })
}

fn pose([x, y, heading]: [&str; 3]) -> Result<Pose2<f64>, RowError> {
    Ok(Pose2::new(number(x)?, number(y)?, number(heading)?))
}
