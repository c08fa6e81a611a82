use std::{
    borrow::Borrow,
    collections::{BTreeMap, BTreeSet},
};

use anyhow::{Result, bail, ensure};
use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::errors::{LandmarkCorrespondence, ReferencePath, TruePositions, align};
use wayfix_sensor_log::{Detection, DetectionTarget, Record, RecordData, Stamp};
use wayfix_slam_ekf::{LandmarkEstimate, LandmarkId};
use wayfix_system_core::{
    DETECTIONS, EventCounts, ODOMETRY, OVERVIEW_HEAD, OdometryRecordKind, RunStep, System, TrueStartPose,
    check_overlap, warn_of_ended_odometry, warn_of_start,
};

use super::{PointSlamFrontEnd, PointSlamParams, PointSystem, SavedPointMap};
use crate::slam::{
    AssociationRule, FIRST_ANCHOR, NO_BATCH, SlamRun, Smoothing, StampedEstimate, start_pose,
    warn_of_gross_errors,
};

/// The result of EKF-SLAM with points on a log; the true map has the landmarks by identity.
pub type PointRun = SlamRun<PointSlamFrontEnd, BTreeMap<u32, Vector2<f64>>>;

/// Runs EKF-SLAM over the records of a log and shows each step to `observe`.
///
/// The start pose is the true pose where odometry starts, or the first true pose after it, moved back by odometry. If the log has positions only,
/// it is the pose with the best fit of the first metres of the path to them; else the origin. The run uses the truth for nothing else.
///
/// # Errors
/// When there is no odometry, no detection, or none that can be used, or a parameter is out of range.
pub fn run(
    records: &[Record],
    params: &PointSlamParams,
    observe: impl FnMut(RunStep<'_, PointSystem>),
) -> Result<PointRun> {
    run_streamed(records, records, params, observe)
}

/// As [`run`], with the records one by one: a long log need not be kept. `overview` is the [overview](wayfix_system_core::LogOverview) of the same log, or all of it.
///
/// # Errors
/// Returns the errors of [`run`].
pub fn run_streamed<R: Borrow<Record>>(
    overview: &[Record],
    records: impl IntoIterator<Item = R>,
    params: &PointSlamParams,
    observe: impl FnMut(RunStep<'_, PointSystem>),
) -> Result<PointRun> {
    let Some(start_stamp) = start_stamp(overview) else {
        bail!(
            "the log has no odometry: EKF-SLAM needs velocities or increments (`wayfix info` shows what a log holds)"
        );
    };
    let association = association(overview, params.association)?;
    check_overlap(overview, ODOMETRY, DETECTIONS)?;
    let truth = ReferencePath::from_records(overview);
    let true_positions = TruePositions::from_records(overview);
    let from =
        |start| PointSystem::with_points(params.clone(), association, start_stamp, start, truth.noise());
    let known = TrueStartPose::at(start_stamp, &truth, overview).filter(|_| params.start_pose.is_none());
    let start = if params.start_pose.is_none() && known.is_none() {
        fitted_start(from(Pose2::new(0.0, 0.0, 0.0))?, overview, &true_positions)
    } else {
        start_pose(params.start_pose, known)
    };
    let mut system = from(start)?;
    if params.start_pose.is_none() {
        warn_of_start(system.events(), known, &truth);
    }
    for (id, landmark) in anchors(overview, association, &start, params.n_anchors) {
        system.add_anchor(id, landmark)?;
    }
    let seen = (association == AssociationRule::Known).then(|| identities(overview));
    system.add_given_anchors(&params.anchors, seen.as_ref(), Vector2::from)?;
    let has_truth = !truth.is_empty() || true_positions.last_stamp().is_some();
    if params.smoothing == Smoothing::FixedLag || has_truth || params.record_graph {
        // Else there is nothing to compare a batch with.
        if let Err(error) = system.follow(None) {
            ensure!(params.smoothing == Smoothing::Reference, error);
            system.events().warn("smoother_failed", format!("{NO_BATCH}: {error}"));
        }
    }
    drive_through(system, truth, overview, records, observe)
}

/// Goes on from a saved map with the records of a log that are later than it, and shows each step to `observe`. `overview` and `records` are as in
/// [`run_streamed`].
///
/// The start pose is that of the map. Figures and events are those of this log alone.
///
/// # Errors
/// When the map is of another kind or is no state of the filter, when no later detection can be used, or a parameter is out of range.
pub fn run_on<R: Borrow<Record>>(
    saved: SavedPointMap,
    overview: &[Record],
    records: impl IntoIterator<Item = R>,
    params: &PointSlamParams,
    observe: impl FnMut(RunStep<'_, PointSystem>),
) -> Result<PointRun> {
    let association = saved.association;
    let system = PointSystem::resume(params.clone(), saved)?;
    self::association(overview, Some(association))?;
    drive_through(system, ReferencePath::from_records(overview), overview, records, observe)
}

fn drive_through<R: Borrow<Record>>(
    system: PointSystem,
    truth: ReferencePath,
    overview: &[Record],
    records: impl IntoIterator<Item = R>,
    observe: impl FnMut(RunStep<'_, PointSystem>),
) -> Result<PointRun> {
    let last_odometry = overview.iter().rev().find_map(odometry_stamp).unwrap_or_default();
    let mut run = SlamRun::new(system, &truth, true_landmarks(overview)).through(records, observe);
    let gate_probability = run.system.filter().params().gate_probability;
    warn_of_gross_errors(run.events(), gate_probability);
    warn_of_ended_odometry(run.events(), overview, DETECTIONS, "the robot is taken to stand");
    let last_truth = run.truth.last_stamp().or(run.true_positions.last_stamp());
    run.evaluated_until = last_truth.map_or(last_odometry, |stamp| stamp.min(last_odometry));
    let is_smoothed = run.system.front_end.params.smoothing == Smoothing::FixedLag;
    if is_smoothed && run.smoothed.is_none() {
        let why = run.events().warnings().iter().find(|warning| warning.name == "smoother_failed");
        bail!("{}", why.map_or("the smoother did not run", |warning| &warning.text));
    }
    if !has_used_a_detection(run.events()) {
        let since = match run.events().get("record_before_resume") {
            0 => "the start of odometry",
            _ => "the stamp of the saved map, after which the log must go on,",
        };
        let why = why(run.events());
        bail!("nothing could be estimated: no detection since {since} was of use{why}");
    }
    Ok(run)
}

impl PointRun {
    /// Estimated positions of the antenna with the true ones, for logs whose truth has no headings.
    pub fn positions(&self) -> Vec<(StampedEstimate, Vector2<f64>, Vector2<f64>)> {
        self.positions_of(|estimate| self.system.antenna(&estimate.pose))
    }
    /// The same of the batch that the filter is compared with.
    pub(super) fn batch_positions(&self) -> Vec<(Vector2<f64>, Vector2<f64>)> {
        let batch = self.smoothed.as_ref().filter(|smoothed| smoothed.is_batch);
        let estimates = batch.map_or(&[][..], |smoothed| smoothed.estimates.kept());
        let evaluated = estimates.iter().filter(|estimate| estimate.stamp <= self.evaluated_until);
        let pair =
            |at: &StampedEstimate| Some((self.system.antenna(&at.pose), self.true_positions.near(at.stamp)?));
        evaluated.filter_map(pair).collect()
    }
    /// Estimated landmark positions.
    pub fn landmarks(&self) -> BTreeMap<u32, Vector2<f64>> {
        let smoothed = self.smoothed.as_ref().filter(|smoothed| !smoothed.is_batch);
        let place = |landmark: LandmarkEstimate<Vector2<f64>>| {
            let place = smoothed.and_then(|smoothed| smoothed.landmarks.get(&landmark.id.0));
            (landmark.id.0, place.copied().unwrap_or(landmark.mean))
        };
        self.system.filter().landmarks().map(place).collect()
    }
    /// How estimated landmarks are compared with true ones.
    pub fn correspondence(&self) -> LandmarkCorrespondence {
        match self.system.association() {
            AssociationRule::Known => LandmarkCorrespondence::ById,
            AssociationRule::Nn | AssociationRule::Jcbb => LandmarkCorrespondence::Nearest,
        }
    }
}

/// Metres of the path whose fit to the true positions gives the start pose: long against the errors of the fixes, short against those of it.
const START_LENGTH: f64 = 40.0;

/// The start from which the first metres of a run fit the true positions best; the origin when there are none.
fn fitted_start(mut pilot: PointSystem, records: &[Record], positions: &TruePositions) -> Pose2<f64> {
    let mut travelled = 0.0;
    let mut last = Vector2::zeros();
    let is_short = |record: &&Record| {
        let _ = pilot.take(record); // what is refused here is refused, and counted, again
        let now = pilot.dead_reckoning().translation;
        travelled += (now - last).norm();
        last = now;
        travelled < START_LENGTH
    };
    records.iter().take(OVERVIEW_HEAD).take_while(is_short).for_each(drop);
    let pair = |stamped_estimate: &StampedEstimate| {
        Some((pilot.antenna(&stamped_estimate.pose), positions.near(stamped_estimate.stamp)?))
    };
    let pairs: Vec<_> = pilot.stamped_estimates().iter().filter_map(pair).collect();
    align(pairs.into_iter())
}

fn has_used_a_detection(events: &EventCounts) -> bool {
    let used = ["new_landmark", "observation_accepted", "observation_downweighted"];
    used.iter().any(|name| events.get(name) > 0)
}

/// The first refusal and how many there were, or else what happened to the detections.
fn why(events: &EventCounts) -> String {
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
    let is_own = |record: &&Record| !matches!(record.data, RecordData::PoseMeasurement(_));
    let stamps = records.iter().filter(is_own).map(|record| record.stamp);
    let earlier = stamps.take_while(|stamp| *stamp < first.stamp).last();
    let is_increment = matches!(first.data, RecordData::OdometryIncrement(_));
    earlier.filter(|_| is_increment).or(Some(first.stamp))
}

fn odometry_stamp(record: &Record) -> Option<Stamp> {
    OdometryRecordKind::of(&record.data).map(|_| record.stamp)
}

/// The requested rule, else by identity if there are identities.
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

fn detections(records: &[Record]) -> impl Iterator<Item = &Detection> {
    records.iter().flat_map(|record| match &record.data {
        RecordData::Detections(detections) => detections.as_slice(),
        _ => &[],
    })
}

/// The identities of the detections.
fn identities(records: &[Record]) -> BTreeSet<u32> {
    let id = |detection: &Detection| match detection.target {
        DetectionTarget::Landmark(id) => Some(id),
        _ => None,
    };
    detections(records).filter_map(id).collect()
}

/// Whether any detection of a landmark carries an identity; `None` when there are no such detections.
fn has_identities(records: &[Record]) -> Option<bool> {
    detections(records).fold(None, |found, detection| match detection.target {
        DetectionTarget::Landmark(_) => Some(true),
        DetectionTarget::Unlabelled => found.or(Some(false)),
        _ => found,
    })
}

/// The `n` true landmarks that are nearest to the start, with the identities that they have in the map.
fn anchors(
    records: &[Record],
    association: AssociationRule,
    start: &Pose2<f64>,
    n: usize,
) -> Vec<(LandmarkId, Vector2<f64>)> {
    let mut nearest: Vec<_> = true_landmarks(records).into_iter().collect();
    let distance = |(_, landmark): &(u32, Vector2<f64>)| (landmark - start.translation).norm();
    nearest.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let by_identity = association == AssociationRule::Known;
    let id = |index: u32, label: u32| LandmarkId(if by_identity { label } else { FIRST_ANCHOR + index });
    (0..).zip(nearest).take(n).map(|(index, (label, landmark))| (id(index, label), landmark)).collect()
}

fn true_landmarks(records: &[Record]) -> BTreeMap<u32, Vector2<f64>> {
    let landmark = |record: &Record| match record.data {
        RecordData::TrueLandmark(landmark) => Some((landmark.id, Vector2::new(landmark.x, landmark.y))),
        _ => None,
    };
    records.iter().filter_map(landmark).collect()
}
