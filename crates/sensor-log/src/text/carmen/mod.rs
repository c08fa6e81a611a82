//! Logs of the Carnegie Mellon Robot Navigation Toolkit (CARMEN), as in the Robotics Data Set Repository (Radish): one message per line.
//!
//! `FLASER` and `ROBOTLASER1` are scans with the poses of the laser and of the robot's odometry, `ODOM` is wheel odometry, and `RAWLASER1` a
//! scan without poses, which is read if there are no others. The records keep the order of the lines, because not all logs have reliable
//! stamps. A scan gives the robot's pose if that differs from odometry, the motion since the previous scan, and the ranges. In corrected
//! logs, the motion is still that of the wheels (see `scan_odometry.rs`). The log is read twice, because the kind of poses, the laser's mount
//! and the clock faults depend on the whole log (`first_pass.rs`).

mod agreement;
mod first_pass;
mod line_clock;
mod row;
mod trajectory;

use std::collections::VecDeque;
use std::path::Path;

use wayfix_estimation_traits::LieGroup;

use self::first_pass::FirstPass;
use self::line_clock::LineClock;
use self::row::{CarmenRow, ScanMessage, ScanPoses, ScanRow, parse};
use super::Lines;
use super::clock_faults::ClockFault;
use super::half_circle::is_half_circle;
use super::row::{RowError, stamp_of};
use super::scan_odometry::ScanOdometry;
use crate::formats::compressed::TextReader;
use crate::{LogCompleteness, LogError, PoseKind, ReadReport, Record, RecordData, RowProblemKind};

pub(crate) fn looks_like(row: &str) -> bool {
    parse(row).is_ok()
}

/// The records of a log, line by line: memory does not grow with its scans.
pub(crate) struct CarmenLog {
    lines: Option<Lines<TextReader>>,
    file: String,
    poses: PoseKind,
    first_pass: FirstPass,
    clock: LineClock,
    odometry: ScanOdometry,
    last_scan: Option<(ScanMessage, f64)>,
    ready: VecDeque<Record>,
}

impl CarmenLog {
    /// Surveys the log; assumptions go into the report.
    pub(crate) fn open(path: &Path, poses: PoseKind, report: &mut ReadReport) -> Result<Self, LogError> {
        let lines = Lines::open(path)?;
        Ok(Self {
            file: lines.file_name(),
            lines: Some(lines),
            poses,
            first_pass: FirstPass::of(path, report)?,
            clock: LineClock::default(),
            odometry: ScanOdometry::default(),
            last_scan: None,
            ready: VecDeque::new(),
        })
    }

    /// The next record; problems go into the report.
    pub(crate) fn next(&mut self, report: &mut ReadReport) -> Option<Record> {
        while self.ready.is_empty() {
            let lines = self.lines.as_mut()?;
            let (number, row) = match lines.next_row() {
                Ok(Some(row)) => (row.number, row.text.and_then(parse)),
                Ok(None) => {
                    self.lines = None;
                    return None;
                }
                Err(error) => {
                    report.end = lines.end_after(error).unwrap_or_else(|error| LogCompleteness::Damaged {
                        byte: lines.n_bytes(),
                        reason: error.to_string(),
                    });
                    self.lines = None;
                    return None;
                }
            };
            let read = match row {
                Ok(CarmenRow::Other(word)) => {
                    report.ignore(&word);
                    continue;
                }
                Ok(CarmenRow::Parameter { .. }) => {
                    report.ignore("PARAM");
                    continue;
                }
                Ok(CarmenRow::Odometry { seconds, pose }) => {
                    self.odometry.line(seconds, pose);
                    Ok(())
                }
                Ok(CarmenRow::Scan(scan)) => match self.why_ignored(&scan) {
                    Some(why) => {
                        report.ignore(&why);
                        continue;
                    }
                    None => self.take_scan(number, scan, report),
                },
                Err(error) => Err(error),
            };
            report.count_row(&self.file, number, read);
        }
        self.ready.pop_front()
    }

    /// Raw scans in a log with posed scans, and scans repeated by another message, are ignored.
    fn why_ignored(&self, scan: &ScanRow) -> Option<String> {
        let word = scan.message.word();
        if scan.message == ScanMessage::Raw && self.first_pass.odometry.is_none() {
            return Some(word.to_owned());
        }
        let (message, seconds) = self.last_scan?;
        let is_again = message != scan.message && seconds == scan.seconds;
        is_again.then(|| format!("{word} (the scan of {} again)", message.word()))
    }

    fn take_scan(&mut self, line: u64, row: ScanRow, report: &mut ReadReport) -> Result<(), RowError> {
        let own = stamp_of(row.seconds)?;
        match self.first_pass.faults.get(&line) {
            Some(ClockFault::Outlier) => {
                let reason = format!("{own} is far from the times of the scans around it");
                return Err(RowError::new(RowProblemKind::BadStamp, reason));
            }
            Some(ClockFault::SetBack(nanoseconds)) => {
                self.clock.was_set_back(*nanoseconds);
                let seconds = *nanoseconds as f64 * 1e-9;
                let text = format!(
                    "{}: the clock is set back by {seconds:.3} s at line {line}: later stamps are shifted so that time continues",
                    self.file
                );
                report.warn("clock_set_back", text);
            }
            None => {}
        }
        self.last_scan = Some((row.message, row.seconds));
        let poses = row.poses.or_else(|| {
            let pose = self.first_pass.odometry.as_ref()?.at(row.seconds)?;
            Some(ScanPoses { laser: pose, odometry: pose })
        });
        let motion = poses.and_then(|poses| self.odometry.scan(row.seconds, poses.odometry));
        let (stamp, verdict) = self.clock.next(own);
        let mut scan = row.scan;
        if row.message == ScanMessage::Front
            && !is_half_circle(scan.ranges.len())
            && let Some((angle_min, angle_increment)) = self.first_pass.angles.get(&scan.ranges.len())
        {
            (scan.angle_min, scan.angle_increment) = (*angle_min, *angle_increment);
        }
        let data = [
            self.first_pass.mount.take().map(RecordData::LaserMount),
            row.poses.and_then(|poses| self.pose(&poses)),
            motion.map(RecordData::OdometryIncrement),
            Some(RecordData::Scan(scan)),
        ];
        self.ready.extend(data.into_iter().flatten().map(|data| Record { stamp, data }));
        verdict
    }

    /// The robot's pose, unless it is the odometry; always, if the caller declares it true.
    fn pose(&self, poses: &ScanPoses) -> Option<RecordData> {
        let is_told = self.first_pass.poses_are_estimates || self.poses == PoseKind::True;
        let robot = match &self.first_pass.pose_mount {
            Some(mount) => poses.laser.compose(&mount.inverse()),
            None => poses.laser,
        };
        is_told.then(|| self.poses.data(robot))
    }
}
