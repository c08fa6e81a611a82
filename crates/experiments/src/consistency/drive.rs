use anyhow::{Context, Result};
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::errors::PoseWithTruth;
use wayfix_sensor_log::{Detection, DetectionTarget, Record, RecordData};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, Observation, RangeBearing, RangeBearingSensor, SlamParams,
};

use super::{ComparedFilter, CorridorLaps};
use crate::monobot::plain_filter;

/// Estimate and truth after one scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConsistencySample {
    /// Since the first record, s.
    pub seconds: f64,
    /// Normalized estimation error squared of the pose, in the filter's own coordinates.
    pub nees: f64,
    /// Distance from the true position, m.
    pub position_error: f64,
    /// Standard deviation of the heading, rad.
    pub heading_sigma: f64,
}

/// Runs a simulated log through one filter from the true start: one entry per scan, from the first one after a motion.
/// # Errors
/// Returns an error if the log has no true start, or the filter refuses a simulated measurement.
pub(crate) fn drive(
    laps: &CorridorLaps,
    records: &[Record],
    kind: ComparedFilter,
) -> Result<Vec<ConsistencySample>> {
    let mut slam = filter(laps, records, kind)?;
    let start_stamp = records.first().context("an empty log")?.stamp;
    let motion = laps.motion();
    let (mut truth, mut has_moved, mut samples) = (*slam.robot(), false, Vec::new());
    for record in records {
        match &record.data {
            RecordData::TruePose(pose) => truth = *pose,
            RecordData::OdometryIncrement(increment) => {
                slam.predict(&motion, increment)?;
                has_moved = true;
            }
            RecordData::Detections(detections) => {
                slam.update(&observations(detections), &mut KnownIdAssociation)?;
                if has_moved {
                    samples.push(consistency_sample(
                        &slam,
                        kind,
                        truth,
                        record.stamp.seconds_since(start_stamp),
                    ));
                }
            }
            _ => {}
        }
    }
    Ok(samples)
}

fn filter(
    laps: &CorridorLaps,
    records: &[Record],
    kind: ComparedFilter,
) -> Result<EkfSlam<RangeBearingSensor>> {
    let start = records.iter().find_map(|record| match record.data {
        RecordData::TruePose(pose) => Some(pose),
        _ => None,
    });
    let params = SlamParams { linearization_point: kind.linearization(), ..plain_filter() };
    let mut slam = EkfSlam::new(laps.sensor(), params, start.context("a log without truth")?)?;
    if kind == ComparedFilter::Anchored {
        for record in records {
            match &record.data {
                RecordData::TrueLandmark(landmark) if landmark.id.is_multiple_of(laps.anchor_every) => {
                    slam.add_anchor(LandmarkId(landmark.id), [landmark.x, landmark.y].into())?;
                }
                _ => {}
            }
        }
    }
    Ok(slam)
}

fn observations(detections: &[Detection]) -> Vec<Observation<RangeBearing>> {
    let observation = |detection: &Detection| match detection.target {
        DetectionTarget::Landmark(id) => {
            let measurement = RangeBearing::new(detection.range, detection.bearing);
            Some(Observation { label: Some(LandmarkId(id)), measurement })
        }
        _ => None,
    };
    detections.iter().filter_map(observation).collect()
}

fn consistency_sample(
    slam: &EkfSlam<RangeBearingSensor>,
    kind: ComparedFilter,
    truth: Pose2<f64>,
    seconds: f64,
) -> ConsistencySample {
    let sample = PoseWithTruth { estimate: *slam.robot(), covariance: slam.robot_covariance(), truth };
    ConsistencySample {
        seconds,
        nees: sample.nees_of(&kind.error(&sample)).unwrap_or(f64::NAN),
        position_error: sample.position_error(),
        heading_sigma: sample.covariance.m33.sqrt(),
    }
}
