use std::io::{self, Write};

use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::{Detection, DetectionTarget, Record, RecordData, Stamp, WriteReport};

/// Writes the records of one stamp as one step. The format has no stamps, so they are lost.
///
/// Every step gets an `O` line, with zero motion if necessary, to separate the steps.
pub(crate) fn write(
    out: &mut impl Write,
    records: impl IntoIterator<Item = Record>,
    report: &mut WriteReport,
) -> io::Result<()> {
    let mut step = Step::default();
    let mut step_stamp: Option<Stamp> = None;
    for record in records {
        if let RecordData::TrueLandmark(landmark) = &record.data {
            writeln!(out, "L {} {} {}", landmark.id, landmark.x, landmark.y)?;
            report.records_written += 1;
            continue;
        }
        if step_stamp.is_some_and(|stamp| stamp != record.stamp) {
            std::mem::take(&mut step).write(out)?;
        }
        match &record.data {
            RecordData::TruePose(pose) => step.pose = Some(*pose),
            RecordData::OdometryIncrement(increment) => step.add_motion(increment),
            RecordData::Detections(detections) => {
                step.detections.extend(detections.iter().filter(|detection| report.can_write(detection)));
            }
            other => {
                report.leave_out(other.kind());
                continue;
            }
        }
        step_stamp = Some(record.stamp);
        report.records_written += 1;
    }
    match step_stamp {
        Some(_) => step.write(out),
        None => Ok(()),
    }
}

#[derive(Default)]
struct Step {
    pose: Option<Pose2<f64>>,
    motion: Option<Pose2<f64>>,
    detections: Vec<Detection>,
}

impl Step {
    fn add_motion(&mut self, increment: &Pose2<f64>) {
        self.motion = Some(self.motion.map_or(*increment, |motion| motion.compose(increment)));
    }

    fn write(self, out: &mut impl Write) -> io::Result<()> {
        if let Some(pose) = self.pose {
            writeln!(out, "P {} {} {}", pose.x(), pose.y(), pose.heading())?;
        }
        let motion = self.motion.unwrap_or_else(Pose2::identity);
        writeln!(out, "O {} {} {}", motion.x(), motion.y(), motion.heading())?;
        for Detection { target, range, bearing } in self.detections {
            match target {
                DetectionTarget::Landmark(id) => writeln!(out, "Z {id} {range} {bearing}")?,
                _ => writeln!(out, "Z ? {range} {bearing}")?,
            }
        }
        Ok(())
    }
}

impl WriteReport {
    /// The format has no place for other robots and unknown codes.
    fn can_write(&mut self, detection: &Detection) -> bool {
        let what = match detection.target {
            DetectionTarget::Landmark(_) | DetectionTarget::Unlabelled => return true,
            DetectionTarget::Robot(_) => "detection of a robot",
            DetectionTarget::UnknownCode(_) => "detection of an unknown code",
        };
        self.leave_out(what);
        false
    }
}
