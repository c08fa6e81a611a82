//! Trajectories as the TUM RGB-D benchmark writes them: `t tx ty tz qx qy qz qw`, seconds, metres, quaternion body → world.
//!
//! A planar pose keeps x, y and the heading of the body's x axis.

use std::io::{self, Write};
use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{RowError, columns, number, stamp};
use super::time_order::{Timed, in_time_order};
use crate::planar::{NORM_TOLERANCE, heading_of, quaternion_of};
use crate::{Data, LogError, PoseKind, ProblemKind, ReadReport, Record, WriteReport};

pub(crate) fn looks_like(row: &str) -> bool {
    parse(row, PoseKind::default()).is_ok()
}

/// The records, sorted by time.
pub(crate) fn read(path: &Path, kind: PoseKind, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let lines = Lines::open(path)?;
    let file = lines.file_name();
    let mut rows = Vec::new();
    lines.for_each_numbered_row(report, |row, text| {
        let Record { stamp, data } = parse(text, kind)?;
        rows.push(Timed { row, stamp, item: data });
        Ok(())
    })?;
    let to_record = |(stamp, data)| Record { stamp, data };
    Ok(in_time_order(&file, rows, report).into_iter().map(to_record).collect())
}

fn parse(row: &str, kind: PoseKind) -> Result<Record, RowError> {
    let [t, x, y, z, qx, qy, qz, qw] = columns(row)?;
    let stamp = stamp(t)?;
    let (x, y, _) = (number(x)?, number(y)?, number(z)?);
    let (qx, qy, qz, qw) = (number(qx)?, number(qy)?, number(qz)?, number(qw)?);
    let norm = (qx * qx + qy * qy + qz * qz + qw * qw).sqrt();
    if (norm - 1.0).abs() > NORM_TOLERANCE {
        return Err(RowError::new(ProblemKind::Inconsistent, format!("quaternion of norm {norm}")));
    }
    let pose = Pose2::new(x, y, heading_of([qx, qy, qz, qw]));
    Ok(Record { stamp, data: kind.data(pose) })
}

/// Writes true and estimated poses alike; the format does not tell them apart.
pub(crate) fn write(
    out: &mut impl Write,
    records: impl IntoIterator<Item = Record>,
    report: &mut WriteReport,
) -> io::Result<()> {
    for record in records {
        let (Data::TruePose(pose) | Data::EstimatedPose(pose)) = &record.data else {
            report.leave_out(record.data.kind());
            continue;
        };
        let (t, [x, y, z, w]) = (record.stamp.nanoseconds(), quaternion_of(pose.heading()));
        let (seconds, rest) = (t / 1_000_000_000, t % 1_000_000_000);
        writeln!(out, "{seconds}.{rest:09} {} {} 0 {x} {y} {z} {w}", pose.x(), pose.y())?;
        report.records_written += 1;
    }
    Ok(())
}
