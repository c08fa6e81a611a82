use std::collections::BTreeMap;

use anyhow::{Result, bail};
use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Data, Record, Stamp, Target};

use super::{
    AssociationRule, SavedMap, SlamSystem, SlamSystemParams, StampedEstimate, start_pose,
    warn_of_an_empty_map, warn_of_no_overlap, warn_of_start,
};
use crate::system::KnownStart;
use crate::system::{DriveStep, Events, ODOMETRY, System, check_overlap, drive};
use wayfix_evaluation::errors::{Correspondence, Sample, TruePositions, TrueTrack, align};

/// A log that went through EKF-SLAM, beside the truth that the log holds.
pub struct SlamRun {
    /// The system in its last state.
    pub system: SlamSystem,
    /// How detections found their landmarks.
    pub association: AssociationRule,
    /// True poses, where the log has them.
    pub truth: TrueTrack,
    /// True positions of the antenna, where the log has them.
    pub true_positions: TruePositions,
    /// True landmarks, where the log has them.
    pub true_landmarks: BTreeMap<u32, Vector2<f64>>,
    /// Keyframes up to here are compared with truth: the last stamp that both odometry and truth have.
    pub evaluated_until: Stamp,
}

/// Runs EKF-SLAM over the records of a log and shows each step to `observe`.
///
/// The start pose is the truth where odometry starts, or led back to there by odometry from the first true pose after it. Where the log has positions only, it is the pose from which the first metres of the
/// path fit them best; else the origin. Nothing else ties the run to the truth.
///
/// # Errors
/// When there is no odometry, no detection, or none that can be used, or a parameter is out of range.
pub fn run(
    records: &[Record],
    params: &SlamSystemParams,
    observe: impl FnMut(DriveStep<'_, SlamSystem>),
) -> Result<SlamRun> {
    let Some(start_stamp) = start_stamp(records) else {
        bail!(
            "the log has no odometry: EKF-SLAM needs velocities or increments (`wayfix info` shows what a log holds)"
        );
    };
    let association = association(records, params.association)?;
    check_overlap(records, ODOMETRY, ("detections", |data| matches!(data, Data::Detections(_))))?;
    let truth = TrueTrack::from_records(records);
    let true_positions = TruePositions::from_records(records);
    let from = |start| SlamSystem::new(params.clone(), association, start_stamp, start, truth.noise());
    let known = KnownStart::at(start_stamp, &truth, records).filter(|_| params.start.is_none());
    let start = if params.start.is_none() && known.is_none() {
        fitted_start(from(Pose2::new(0.0, 0.0, 0.0))?, records, &true_positions)
    } else {
        start_pose(params.start, known)
    };
    let mut system = from(start)?;
    if params.start.is_none() {
        warn_of_start(system.events(), known, &truth);
    }
    drive_through(system, association, truth, records, observe)
}

/// Goes on from a saved map with the records of a log that are later than it, and shows each step to `observe`.
///
/// The start pose is that of the map. Keyframes, figures and events are those of this log alone.
///
/// # Errors
/// When the map is of another kind or is no state of the filter, when no later detection can be used, or a parameter is out of range.
pub fn run_on(
    saved: SavedMap,
    records: &[Record],
    params: &SlamSystemParams,
    observe: impl FnMut(DriveStep<'_, SlamSystem>),
) -> Result<SlamRun> {
    let association = saved.state.association;
    let system = SlamSystem::resume(params.clone(), saved)?;
    self::association(records, Some(association))?;
    drive_through(system, association, TrueTrack::from_records(records), records, observe)
}

fn drive_through(
    mut system: SlamSystem,
    association: AssociationRule,
    truth: TrueTrack,
    records: &[Record],
    observe: impl FnMut(DriveStep<'_, SlamSystem>),
) -> Result<SlamRun> {
    drive(&mut system, records, observe);
    if !has_used_a_detection(system.events()) {
        bail!(
            "nothing could be estimated: no detection since the start of odometry was of use{}",
            why(system.events())
        );
    }
    let stamped_estimates = system.stamped_estimates();
    let estimated = stamped_estimates
        .first()
        .zip(stamped_estimates.last())
        .map(|(first, last)| (first.stamp, last.stamp));
    warn_of_no_overlap(system.events(), &truth, estimated);
    let n_landmarks = system.filter().n_landmarks();
    warn_of_an_empty_map(system.events(), n_landmarks);
    let true_positions = TruePositions::from_records(records);
    let last_odometry = records.iter().rev().find_map(odometry_stamp).unwrap_or_default();
    let last_truth = truth.last_stamp().or(true_positions.last_stamp());
    let evaluated_until = last_truth.map_or(last_odometry, |stamp| stamp.min(last_odometry));
    Ok(SlamRun {
        system,
        association,
        truth,
        true_positions,
        true_landmarks: true_landmarks(records),
        evaluated_until,
    })
}

impl SlamRun {
    /// Keyframes with their true poses.
    pub fn samples(&self) -> Vec<(StampedEstimate, Sample)> {
        let sample = |stamped_estimate: &StampedEstimate| {
            let StampedEstimate { stamp, pose, covariance, .. } = stamped_estimate;
            Some((*stamped_estimate, self.truth.sample(*stamp, *pose, covariance)?))
        };
        let evaluated = |stamped_estimate: &&StampedEstimate| stamped_estimate.stamp <= self.evaluated_until;
        self.system.stamped_estimates().iter().filter(evaluated).filter_map(sample).collect()
    }
    /// Estimated positions of the antenna with the true ones, for logs whose truth has no headings.
    pub fn positions(&self) -> Vec<(StampedEstimate, Vector2<f64>, Vector2<f64>)> {
        let pair = |stamped_estimate: &StampedEstimate| {
            let truth = self.true_positions.near(stamped_estimate.stamp)?;
            let until = stamped_estimate.stamp <= self.evaluated_until;
            until.then(|| (*stamped_estimate, self.system.antenna(&stamped_estimate.pose), truth))
        };
        self.system.stamped_estimates().iter().filter_map(pair).collect()
    }
    /// Estimated landmark positions.
    pub fn landmarks(&self) -> BTreeMap<u32, Vector2<f64>> {
        self.system.filter().landmarks().map(|landmark| (landmark.id.0, landmark.mean)).collect()
    }
    /// How estimated landmarks are compared with true ones.
    pub fn correspondence(&self) -> Correspondence {
        match self.association {
            AssociationRule::Known => Correspondence::ById,
            AssociationRule::Nn | AssociationRule::Jcbb => Correspondence::Nearest,
        }
    }
    /// What happened.
    pub fn events(&mut self) -> &mut Events {
        self.system.events()
    }
}

/// Metres of the path whose fit to the true positions gives the start pose: long against the errors of the fixes, short against those of
/// the path.
const START_LENGTH: f64 = 40.0;

/// The start from which the first metres of a run fit the true positions best; the origin when there are none.
fn fitted_start(mut pilot: SlamSystem, records: &[Record], positions: &TruePositions) -> Pose2<f64> {
    let mut travelled = 0.0;
    let mut last = Vector2::zeros();
    let is_short = |record: &&Record| {
        let _ = pilot.take(record); // what is refused here is refused, and counted, again
        let now = pilot.dead_reckoning().translation;
        travelled += (now - last).norm();
        last = now;
        travelled < START_LENGTH
    };
    records.iter().take_while(is_short).for_each(drop);
    let pair = |stamped_estimate: &StampedEstimate| {
        Some((pilot.antenna(&stamped_estimate.pose), positions.near(stamped_estimate.stamp)?))
    };
    let pairs: Vec<_> = pilot.stamped_estimates().iter().filter_map(pair).collect();
    align(pairs.into_iter())
}

fn has_used_a_detection(events: &Events) -> bool {
    ["new_landmark", "accepted", "accepted_downweighted"].iter().any(|name| events.get(name) > 0)
}

/// The first refusal and how many there were, or else what happened to the detections.
fn why(events: &Events) -> String {
    let Some(first) = events.refusals().first() else {
        let counts: Vec<String> = events.counts().iter().map(|(name, n)| format!("{name} {n}")).collect();
        let what = if counts.is_empty() { "all detections are empty".to_owned() } else { counts.join(", ") };
        return format!(" ({what})");
    };
    format!("; the first of {} refusals: {first}", events.n_refusals())
}

/// Where the known start is: at the first velocity, which holds from there on; for increments, which lead from an earlier pose to
/// their stamp, at the last record before the first of them.
fn start_stamp(records: &[Record]) -> Option<Stamp> {
    let first = records.iter().find(|record| odometry_stamp(record).is_some())?;
    let earlier = records.iter().map(|record| record.stamp).take_while(|stamp| *stamp < first.stamp).last();
    match first.data {
        Data::OdometryIncrement(_) => Some(earlier.unwrap_or(first.stamp)),
        _ => Some(first.stamp),
    }
}

fn odometry_stamp(record: &Record) -> Option<Stamp> {
    matches!(record.data, Data::Velocity(_) | Data::Ackermann(_) | Data::OdometryIncrement(_))
        .then_some(record.stamp)
}

/// The rule that was asked for, else by identity where there are identities.
fn association(records: &[Record], asked: Option<AssociationRule>) -> Result<AssociationRule> {
    let association = match (asked, has_identities(records)) {
        (Some(rule), _) => rule,
        (None, Some(true)) => AssociationRule::Known,
        (None, Some(false)) => AssociationRule::Jcbb,
        (None, None) => bail!(
            "the log has no range-bearing detections of landmarks (`wayfix info` shows what a log holds)"
        ),
    };
    if association == AssociationRule::Known && has_identities(records) == Some(false) {
        bail!("no detection carries an identity: use nearest neighbour (--association nn)");
    }
    Ok(association)
}

/// Whether any detection of a landmark carries an identity; `None` when there are no such detections.
fn has_identities(records: &[Record]) -> Option<bool> {
    let detections = records.iter().flat_map(|record| match &record.data {
        Data::Detections(detections) => detections.as_slice(),
        _ => &[],
    });
    detections.fold(None, |found, detection| match detection.target {
        Target::Landmark(_) => Some(true),
        Target::Unlabelled => found.or(Some(false)),
        _ => found,
    })
}

fn true_landmarks(records: &[Record]) -> BTreeMap<u32, Vector2<f64>> {
    let landmark = |record: &Record| match record.data {
        Data::TrueLandmark(landmark) => Some((landmark.id, Vector2::new(landmark.x, landmark.y))),
        _ => None,
    };
    records.iter().filter_map(landmark).collect()
}
