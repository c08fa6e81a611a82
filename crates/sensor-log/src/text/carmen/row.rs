use std::str::SplitAsciiWhitespace;

use wayfix_estimation_traits::Pose2;

use crate::formats::format::shortened;
use crate::text::half_circle::half_circle;
use crate::text::row::{RowError, columns, number, range};
use crate::{LaserScan, RowProblemKind};

/// First words of messages that the Carnegie Mellon toolkit logs and this crate has no use for; some carry the number of a device.
const OTHER_WORDS: [&str; 7] = ["SYNC", "NEFF", "RLASER", "TRUEPOS", "LASER", "RAWLASER", "ROBOTLASER"];

/// Columns of a `FLASER` line besides the ranges: the word, their number, two poses, time, host and time.
const SCAN_COLUMNS: usize = 11;

/// Columns of a `ROBOTLASER1` line after the remissions: two poses, two velocities, three numbers of the robot, time, host and time.
const ROBOT_TAIL: usize = 14;

/// Columns of a `RAWLASER1` line after the remissions: time, host and time.
const RAW_TAIL: usize = 3;

/// A line of a CARMEN log.
pub(super) enum CarmenRow {
    Scan(ScanRow),
    Odometry {
        seconds: f64,
        pose: Pose2<f64>,
    },
    /// A parameter of the robot.
    Parameter {
        name: String,
        value: String,
    },
    /// A message that is not read: its first word.
    Other(String),
}

/// A line with a scan.
pub(super) struct ScanRow {
    pub(super) message: ScanMessage,
    pub(super) seconds: f64,
    pub(super) scan: LaserScan,
    /// Poses of laser and robot; a raw scan has none.
    pub(super) poses: Option<ScanPoses>,
}

/// The messages that hold a scan of the first laser.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ScanMessage {
    /// `FLASER`, which does not state its angles.
    Front,
    /// `ROBOTLASER1`, which does.
    Robot,
    /// `RAWLASER1`, which has no pose.
    Raw,
}

impl ScanMessage {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Front => "FLASER",
            Self::Robot => "ROBOTLASER1",
            Self::Raw => "RAWLASER1",
        }
    }
}

/// The two poses of a scan.
#[derive(Clone, Copy)]
pub(super) struct ScanPoses {
    /// Pose of the laser, corrected in a corrected log.
    pub(super) laser: Pose2<f64>,
    /// Odometry pose of the robot.
    pub(super) odometry: Pose2<f64>,
}

pub(super) fn parse(row: &str) -> Result<CarmenRow, RowError> {
    let mut rest = row.split_ascii_whitespace();
    match rest.next().unwrap_or_default() {
        "FLASER" => Ok(CarmenRow::Scan(front_scan(row, rest)?)),
        "ROBOTLASER1" => Ok(CarmenRow::Scan(stated_scan(rest, ScanMessage::Robot)?)),
        "RAWLASER1" => Ok(CarmenRow::Scan(stated_scan(rest, ScanMessage::Raw)?)),
        "ODOM" => {
            let [_, x, y, heading, _, _, _, seconds, _, _] = columns(row)?;
            Ok(CarmenRow::Odometry { seconds: number(seconds)?, pose: pose([x, y, heading])? })
        }
        "PARAM" => {
            let mut word = || rest.next().unwrap_or_default().to_owned();
            Ok(CarmenRow::Parameter { name: word(), value: word() })
        }
        word if OTHER_WORDS.contains(&word.trim_end_matches(|c: char| c.is_ascii_digit())) => {
            Ok(CarmenRow::Other(word.to_owned()))
        }
        word => {
            let reason = format!("{:?} is no message of CARMEN", shortened(word));
            Err(RowError::new(RowProblemKind::Unrecognized, reason))
        }
    }
}

/// `FLASER n [ranges] x y heading x_odo y_odo heading_odo t host t_logger`.
fn front_scan(row: &str, mut rest: SplitAsciiWhitespace<'_>) -> Result<ScanRow, RowError> {
    let n_columns = row.split_ascii_whitespace().count();
    let n_beams = number(rest.next().unwrap_or_default())?;
    let n_expected = n_beams + SCAN_COLUMNS as f64;
    if n_columns as f64 != n_expected {
        let reason = format!("{n_columns} columns instead of {n_expected} for {n_beams} beams");
        return Err(RowError::new(RowProblemKind::ColumnCount, reason));
    }
    let ranges: Result<Vec<f64>, RowError> =
        rest.by_ref().take(n_columns - SCAN_COLUMNS).map(range).collect();
    let scan = half_circle(ranges?)?;
    let poses = poses(&mut rest)?;
    let seconds = number(rest.next().unwrap_or_default())?;
    Ok(ScanRow { message: ScanMessage::Front, seconds, scan, poses: Some(poses) })
}

/// `ROBOTLASER1 type start_angle field_of_view resolution maximum_range accuracy remission_mode n [ranges] m [remissions]`, then the
/// poses of laser and robot, `tv rv forward_safety side_safety turn_axis t host t_logger`; `RAWLASER1` has but `t host t_logger` there.
fn stated_scan(mut rest: SplitAsciiWhitespace<'_>, message: ScanMessage) -> Result<ScanRow, RowError> {
    let mut next = || number(rest.next().unwrap_or_default());
    let (_, angle_min, field, resolution, maximum, _, _) =
        (next()?, next()?, next()?, next()?, next()?, next()?, next()?);
    let ranges = counted(&mut rest)?;
    counted(&mut rest)?; // remissions
    let n_expected = if message == ScanMessage::Raw { RAW_TAIL } else { ROBOT_TAIL };
    let n_columns = rest.clone().count();
    if n_columns != n_expected {
        let reason = format!("{n_columns} columns instead of {n_expected} after the remissions");
        return Err(RowError::new(RowProblemKind::ColumnCount, reason));
    }
    let angle_increment = increment(field, resolution, ranges.len())?;
    let range_max = if maximum > 0.0 { maximum } else { f64::INFINITY };
    let scan = LaserScan { angle_min, angle_increment, range_max, beam_period: 0.0, ranges };
    let poses = if message == ScanMessage::Raw { None } else { Some(poses(&mut rest)?) };
    let n_between = if message == ScanMessage::Raw { 0 } else { 5 };
    let seconds = number(rest.nth(n_between).unwrap_or_default())?;
    Ok(ScanRow { message, seconds, scan, poses })
}

/// A number, and that many ranges.
fn counted(rest: &mut SplitAsciiWhitespace<'_>) -> Result<Vec<f64>, RowError> {
    let count = number(rest.next().unwrap_or_default())?;
    let n_left = rest.clone().count();
    if count < 0.0 || count.fract() != 0.0 || count > n_left as f64 {
        let reason = format!("{n_left} columns are left for {count} readings");
        return Err(RowError::new(RowProblemKind::ColumnCount, reason));
    }
    rest.by_ref().take(count as usize).map(range).collect()
}

/// The angle between two beams: the resolution, unless it misses the field of view by more than one beam.
///
/// Scanners return one beam more or less than field divided by resolution.
fn increment(field: f64, resolution: f64, n_beams: usize) -> Result<f64, RowError> {
    if n_beams < 2 {
        let reason = format!("{n_beams} beams have no field of view");
        return Err(RowError::new(RowProblemKind::Inconsistent, reason));
    }
    let spanned = (n_beams - 1) as f64;
    let resolution_fits = resolution != 0.0 && (field - resolution * spanned).abs() < 1.5 * resolution.abs();
    match (resolution_fits, field > 0.0) {
        (true, _) => Ok(resolution),
        (false, true) => Ok(field / spanned),
        (false, false) => {
            let reason = format!("a field of view of {field} rad in {n_beams} beams {resolution} rad apart");
            Err(RowError::new(RowProblemKind::Inconsistent, reason))
        }
    }
}

fn poses(rest: &mut SplitAsciiWhitespace<'_>) -> Result<ScanPoses, RowError> {
    let mut triple = || pose([(); 3].map(|()| rest.next().unwrap_or_default()));
    Ok(ScanPoses { laser: triple()?, odometry: triple()? })
}

fn pose([x, y, heading]: [&str; 3]) -> Result<Pose2<f64>, RowError> {
    Ok(Pose2::new(number(x)?, number(y)?, number(heading)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(row: &str) -> ScanRow {
        match parse(row) {
            Ok(CarmenRow::Scan(scan)) => scan,
            _ => panic!("{row} is a scan"),
        }
    }

    fn problem(row: &str) -> RowProblemKind {
        parse(row).err().expect("a bad row").kind
    }

    #[test]
    fn robotlaser_states_its_angles_its_range_and_two_poses() {
        let row = "ROBOTLASER1 0 -1.2 2.4 0.6 4.0 0.01 0 5 1 2 nan 4 5 2 9 9 0.5 0 0.1 0.25 0 0.1 1 2 3 4 5 7.5 host 8";
        let scan = scan(row);
        assert_eq!((scan.scan.angle_min, scan.scan.angle_increment, scan.scan.range_max), (-1.2, 0.6, 4.0));
        assert_eq!((scan.scan.ranges.len(), scan.scan.echoes().count()), (5, 2));
        let poses = scan.poses.expect("it has poses");
        assert_eq!((poses.laser.x(), poses.odometry.x(), poses.odometry.heading()), (0.5, 0.25, 0.1));
        assert_eq!(scan.seconds, 7.5);
    }

    #[test]
    fn rawlaser_has_no_pose() {
        let scan = scan("RAWLASER1 0 -1 2 1 80 0.01 0 3 1 2 3 0 7.5 host 8");
        assert!(scan.poses.is_none() && scan.seconds == 7.5 && scan.scan.ranges == [1.0, 2.0, 3.0]);
    }

    #[test]
    fn a_resolution_that_contradicts_the_field_of_view_gives_way() {
        assert_eq!(increment(3.0, 0.5, 7).unwrap(), 0.5);
        assert_eq!(increment(3.0, 0.5, 6).unwrap(), 0.5); // the last beam is missing
        assert_eq!(increment(3.0, 1.0, 7).unwrap(), 0.5);
        assert_eq!(increment(3.0, 0.0, 7).unwrap(), 0.5);
        assert_eq!(increment(0.0, 0.0, 7).unwrap_err().kind, RowProblemKind::Inconsistent);
        assert_eq!(increment(3.0, 0.5, 1).unwrap_err().kind, RowProblemKind::Inconsistent);
    }

    #[test]
    fn robotlaser_with_other_counts_than_stated_is_refused() {
        assert_eq!(problem("ROBOTLASER1 0 -1 2 1 80 0.01 0 9 1 2 3 0"), RowProblemKind::ColumnCount);
        assert_eq!(problem("ROBOTLASER1 0 -1 2 1 80 0.01 0 3 1 2 3 0 0 0 0"), RowProblemKind::ColumnCount);
        assert_eq!(problem("ROBOTLASER1 0 -1 2 1 80 0.01 0 -3 1 2 3"), RowProblemKind::ColumnCount);
        assert_eq!(problem("ROBOTLASER1 0 nan 2 1 80"), RowProblemKind::NotFinite);
        assert_eq!(problem("ROBOTLASER1"), RowProblemKind::NotANumber);
    }
}
