//! Logs of the Carnegie Mellon Robot Navigation Toolkit (CARMEN), as the Robotics Data Set Repository (Radish) has them: one message a line.
//!
//! `FLASER n r_1 … r_n x y heading x_odo y_odo heading_odo t host t_logger` is a scan over the half circle ahead, `ODOM` what the wheels say.
//! The order is that of the lines, for not all logs have stamps to go by. A scan gives three records: its pose, the motion since the
//! scan before, and what the laser saw. In corrected logs, the motion is still that of the wheels (`scan_odometry.rs` says how).

use std::collections::VecDeque;
use std::path::Path;

use super::Lines;
use super::carmen_row::{CarmenRow, ScanRow, parse};
use super::line_clock::LineClock;
use super::row::{RowError, stamp_of};
use super::scan_odometry::ScanOdometry;
use crate::compressed::TextReader;
use crate::{Data, LogEnd, LogError, PoseKind, ReadReport, Record};

pub(crate) fn looks_like(row: &str) -> bool {
    parse(row).is_ok()
}

/// The records of a log, line by line: memory does not grow with the file.
pub(crate) struct CarmenLog {
    lines: Option<Lines<TextReader>>,
    file: String,
    poses: PoseKind,
    clock: LineClock,
    odometry: ScanOdometry,
    ready: VecDeque<Record>,
}

impl CarmenLog {
    pub(crate) fn open(path: &Path, poses: PoseKind) -> Result<Self, LogError> {
        let lines = Lines::open(path)?;
        Ok(Self {
            file: lines.file_name(),
            lines: Some(lines),
            poses,
            clock: LineClock::default(),
            odometry: ScanOdometry::default(),
            ready: VecDeque::new(),
        })
    }

    /// The next record; trouble goes into the report.
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
                    report.end = lines.end_after(error).unwrap_or_else(|error| LogEnd::Damaged {
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
                Ok(CarmenRow::Odometry { seconds, pose }) => {
                    self.odometry.line(seconds, pose);
                    Ok(())
                }
                Ok(CarmenRow::Scan(scan)) => self.take_scan(scan),
                Err(error) => Err(error),
            };
            report.count_row(&self.file, number, read);
        }
        self.ready.pop_front()
    }

    fn take_scan(&mut self, row: ScanRow) -> Result<(), RowError> {
        let motion = self.odometry.scan(row.seconds, row.odometry);
        let (stamp, verdict) = self.clock.next(stamp_of(row.seconds)?);
        let data = [
            Some(self.poses.data(row.pose)),
            motion.map(Data::OdometryIncrement),
            Some(Data::Scan(row.scan)),
        ];
        self.ready.extend(data.into_iter().flatten().map(|data| Record { stamp, data }));
        verdict
    }
}
