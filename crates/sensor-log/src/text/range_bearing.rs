//! Plain range-bearing logs: `L id x y` landmark, `P x y heading` true pose, `O dx dy dheading` increment in the robot frame,
//! `Z id range bearing` detection; `Z -1 …` or `Z ? …` for a detection without identity.
//!
//! There are no stamps. Within a step the order is `P`, `O`, `Z…`; a line that cannot follow in that order begins the next step, and step `k`
//! (from 0) gets the stamp `k × 0.1 s`.

use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{RowError, columns, id, number};
use crate::formats::format::shortened;
use crate::{
    Detection, DetectionTarget, LogError, ReadReport, Record, RecordData, RowProblemKind, Stamp, TrueLandmark,
};

/// Time between two steps, nanoseconds.
const STEP_NANOSECONDS: u64 = 100_000_000;

pub(crate) fn looks_like(row: &str) -> bool {
    parse(row).is_ok()
}

pub(crate) fn read(path: &Path, report: &mut ReadReport) -> Result<Vec<Record>, LogError> {
    let mut steps = Steps::default();
    Lines::open(path)?.for_each_row(report, |row| {
        steps.push(parse(row)?);
        Ok(())
    })?;
    Ok(steps.into_records())
}

enum Line {
    Landmark(TrueLandmark),
    Pose(Pose2<f64>),
    Odometry(Pose2<f64>),
    Detection(Detection),
}

fn parse(row: &str) -> Result<Line, RowError> {
    let word = row.split_ascii_whitespace().next().unwrap_or_default();
    if !matches!(word, "L" | "P" | "O" | "Z") {
        let reason = format!("{:?} is none of L, P, O, Z", shortened(word));
        return Err(RowError::new(RowProblemKind::Unrecognized, reason));
    }
    let [_, first, second, third] = columns(row)?;
    let (b, c) = (number(second)?, number(third)?);
    Ok(match word {
        "L" => Line::Landmark(TrueLandmark { id: id(first)?, x: b, y: c }),
        "P" => Line::Pose(Pose2::new(number(first)?, b, c)),
        "O" => Line::Odometry(Pose2::new(number(first)?, b, c)),
        _ => {
            let target = if matches!(first, "-1" | "?") {
                DetectionTarget::Unlabelled
            } else {
                DetectionTarget::Landmark(id(first)?)
            };
            Line::Detection(Detection { target, range: b, bearing: c })
        }
    })
}

/// The lines so far, divided into steps.
#[derive(Default)]
struct Steps {
    landmarks: Vec<Record>,
    records: Vec<Record>,
    step: u64,
    detections: Vec<Detection>,
    has_pose: bool,
    has_odometry: bool,
}

impl Steps {
    fn push(&mut self, line: Line) {
        match line {
            Line::Landmark(landmark) => {
                let stamp = Stamp::default();
                self.landmarks.push(Record { stamp, data: RecordData::TrueLandmark(landmark) });
            }
            Line::Pose(pose) => {
                self.next_step_if(self.has_pose || self.has_odometry || !self.detections.is_empty());
                self.has_pose = true;
                self.record(RecordData::TruePose(pose));
            }
            Line::Odometry(increment) => {
                self.next_step_if(self.has_odometry || !self.detections.is_empty());
                self.has_odometry = true;
                self.record(RecordData::OdometryIncrement(increment));
            }
            Line::Detection(detection) => self.detections.push(detection),
        }
    }

    fn next_step_if(&mut self, begins: bool) {
        if begins {
            self.finish_detections();
            self.step += 1;
            (self.has_pose, self.has_odometry) = (false, false);
        }
    }

    fn finish_detections(&mut self) {
        if !self.detections.is_empty() {
            let detections = std::mem::take(&mut self.detections);
            self.record(RecordData::Detections(detections));
        }
    }

    fn record(&mut self, data: RecordData) {
        let stamp = Stamp::from_nanoseconds(self.step.saturating_mul(STEP_NANOSECONDS));
        self.records.push(Record { stamp, data });
    }

    fn into_records(mut self) -> Vec<Record> {
        self.finish_detections();
        self.landmarks.append(&mut self.records);
        self.landmarks
    }
}
