//! Trajectories as the TUM RGB-D benchmark writes them: `t tx ty tz qx qy qz qw`, seconds, metres, quaternion body → world.
//!
//! A planar pose keeps x, y and the heading of the body's x axis. Commas may separate the columns. A header or comment that names `qx`, `qy`, `qz` and
//! `qw` in another order is followed.

use std::io::{self, Read, Write};
use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{RowError, exactly, number, stamp};
use super::time_order::{Timed, rows_in_time_order};
use crate::formats::compressed::open_text;
use crate::planar::{NORM_TOLERANCE, heading_of, quaternion_of};
use crate::{LogError, PoseKind, ReadReport, Record, RecordData, RowProblemKind, WriteReport};

pub(crate) fn looks_like(row: &str) -> bool {
    parse(row, &ORDER, PoseKind::default()).is_ok()
}

/// The records, sorted by time.
pub(crate) fn read(path: &Path, kind: PoseKind, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let order = order_of(path)?;
    let rows = rows_in_time_order(Lines::open(path)?, report, |text| {
        let Record { stamp, data } = parse(text, &order, kind)?;
        Ok((stamp, data))
    })?;
    let to_record = |Timed { stamp, item: data, .. }| Record { stamp, data };
    Ok(rows.into_iter().map(to_record).collect())
}

/// Positions of the columns t, x, y, z, qx, qy, qz, qw.
type Order = [usize; 8];

const ORDER: Order = [0, 1, 2, 3, 4, 5, 6, 7];

/// The columns of a file, as the first line that names them has them.
fn order_of(path: &Path) -> Result<Order, LogError> {
    let mut beginning = Vec::new();
    // Decompression errors are reported when the rows are read.
    let _ = open_text(path)?.take(HEADER_BYTES).read_to_end(&mut beginning);
    let beginning = String::from_utf8_lossy(&beginning).into_owned();
    Ok(beginning.lines().find_map(order_in).unwrap_or(ORDER))
}

/// A header is among the first bytes.
const HEADER_BYTES: u64 = 4096;

fn order_in(line: &str) -> Option<Order> {
    let names: Vec<&str> = words(line.trim_start_matches('#')).collect();
    let at = |name| names.iter().position(|known| known.eq_ignore_ascii_case(name));
    let rotation = [at("qx")?, at("qy")?, at("qz")?, at("qw")?];
    let mut others = (0..names.len()).filter(|index| !rotation.contains(index));
    let [t, x, y, z] = [others.next()?, others.next()?, others.next()?, others.next()?];
    let [qx, qy, qz, qw] = rotation;
    (names.len() == ORDER.len()).then_some([t, x, y, z, qx, qy, qz, qw])
}

fn words(row: &str) -> impl Iterator<Item = &str> {
    row.split(|c: char| c.is_ascii_whitespace() || c == ',').filter(|word| !word.is_empty())
}

fn parse(row: &str, order: &Order, kind: PoseKind) -> Result<Record, RowError> {
    let columns: [&str; 8] = exactly(words(row))?;
    let [t, x, y, z, qx, qy, qz, qw] = order.map(|index| columns[index]);
    let stamp = stamp(t)?;
    let (x, y, _) = (number(x)?, number(y)?, number(z)?);
    let (qx, qy, qz, qw) = (number(qx)?, number(qy)?, number(qz)?, number(qw)?);
    let norm = (qx * qx + qy * qy + qz * qz + qw * qw).sqrt();
    if (norm - 1.0).abs() > NORM_TOLERANCE {
        return Err(RowError::new(RowProblemKind::Inconsistent, format!("quaternion of norm {norm}")));
    }
    let pose = Pose2::new(x, y, heading_of([qx, qy, qz, qw]));
    Ok(Record { stamp, data: kind.data(pose) })
}

/// Writes the estimated poses, else the true ones: the format does not distinguish them.
pub(crate) fn write(
    out: &mut impl Write,
    records: impl IntoIterator<Item = Record>,
    report: &mut WriteReport,
) -> io::Result<()> {
    let (mut truth, mut estimates) = (Vec::new(), Vec::new());
    for record in records {
        match record.data {
            RecordData::TruePose(pose) => truth.push((record.stamp, pose)),
            RecordData::EstimatedPose(pose) => estimates.push((record.stamp, pose)),
            other => report.leave_out(other.kind()),
        }
    }
    let written = if estimates.is_empty() {
        &truth
    } else {
        truth.iter().for_each(|_| report.leave_out("true pose beside estimated ones"));
        &estimates
    };
    for (stamp, pose) in written {
        let (t, [x, y, z, w]) = (stamp.nanoseconds(), quaternion_of(pose.heading()));
        let (seconds, rest) = (t / 1_000_000_000, t % 1_000_000_000);
        writeln!(out, "{seconds}.{rest:09} {} {} 0 {x} {y} {z} {w}", pose.x(), pose.y())?;
        report.records_written += 1;
    }
    Ok(())
}
