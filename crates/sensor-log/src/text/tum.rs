//! Trajectories as the TUM RGB-D benchmark writes them: `t tx ty tz qx qy qz qw`, seconds, metres, quaternion body → world.
//!
//! A planar pose keeps x, y and the heading of the body's x axis.

use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{RowError, columns, number, stamp};
use super::time_check::TimeCheck;
use crate::{Data, LogError, PoseKind, ProblemKind, ReadReport, Record};

/// How far from 1 the norm of a quaternion may be; a few printed digits give 1e-3.
const NORM_TOLERANCE: f64 = 0.05;

pub(crate) fn looks_like(row: &str) -> bool {
    parse(row, PoseKind::default()).is_ok()
}

/// The records, sorted by time.
pub(crate) fn read(path: &Path, kind: PoseKind, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let mut records = Vec::new();
    let mut time = TimeCheck::default();
    Lines::open(path)?.for_each_row(report, |row| {
        let record = parse(row, kind)?;
        let stamp = record.stamp;
        records.push(record);
        time.check(stamp)
    })?;
    records.sort_by_key(|record| record.stamp);
    Ok(records)
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
    let heading = (2.0 * (qw * qz + qx * qy)).atan2(qw * qw + qx * qx - qy * qy - qz * qz);
    let pose = Pose2::new(x, y, heading);
    let data = match kind {
        PoseKind::Estimated => Data::EstimatedPose(pose),
        PoseKind::True => Data::TruePose(pose),
    };
    Ok(Record { stamp, data })
}
