use std::borrow::Borrow;

use anyhow::{Result, bail};
use wayfix_estimation_traits::Manifold;
use wayfix_evaluation::errors::{PoseWithTruth, ReferencePath};
use wayfix_sensor_log::{Record, RecordData, TrueWall};
use wayfix_slam_ekf::LandmarkId;
use wayfix_system_core::{
    EventCounts, ODOMETRY, RunStep, SCANS, System, TrueStartPose, check_overlap, warn_of_ended_odometry,
    warn_of_reference, warn_of_start, without_odometry_delay,
};

use super::{SavedWallMap, WallSlamFrontEnd, WallSlamParams, WallSystem, batch::WallBatch, truth};
use crate::slam::{AssociationRule, FIRST_ANCHOR, SlamRun, StampedEstimate, start_pose};

/// The result of EKF-SLAM with walls on a log of scans.
pub type WallRun = SlamRun<WallSlamFrontEnd, Vec<TrueWall>>;

/// Runs EKF-SLAM with walls over the records of a log and shows each step to `observe`.
///
/// The start pose is the true pose at the first scan, or the first true pose after it, moved back by odometry; else the origin.
/// The run uses the truth for nothing else.
///
/// # Errors
/// When there is no odometry, no scan, or a parameter is out of range.
pub fn run(
    records: &[Record],
    params: &WallSlamParams,
    observe: impl FnMut(RunStep<'_, WallSystem>),
) -> Result<WallRun> {
    let in_time = without_odometry_delay(records, params.odometry_delay);
    run_streamed(records, in_time.iter(), params, observe)
}

/// As [`run`], with the records one by one: a long log need not be kept. `overview` is the same log, whose scans may be without ranges; a delay of
/// odometry was taken out of `records` already.
///
/// # Errors
/// Returns the errors of [`run`].
pub fn run_streamed<R: Borrow<Record>>(
    overview: &[Record],
    records: impl IntoIterator<Item = R>,
    params: &WallSlamParams,
    observe: impl FnMut(RunStep<'_, WallSystem>),
) -> Result<WallRun> {
    let first = |is: fn(&RecordData) -> bool| overview.iter().find(|record| is(&record.data));
    let Some(scan) = first(|data| matches!(data, RecordData::Scan(_))) else {
        bail!("the log has no laser scans (`wayfix info` shows what a log holds)");
    };
    let Some(moves_by_velocity) = moves_by_velocity(overview) else {
        bail!(
            "the log has neither odometry increments nor velocities, which EKF-SLAM with walls needs (`wayfix info` shows what it holds)"
        );
    };
    check_overlap(overview, ODOMETRY, SCANS)?;
    let track = ReferencePath::from_records_or_estimates(overview);
    let known = TrueStartPose::at(scan.stamp, &track, overview).filter(|_| params.start_pose.is_none());
    let start = start_pose(params.start_pose, known);
    let laser = params.laser_pose.or_else(|| laser_mount(overview));
    let placed = WallSlamParams { laser_pose: laser, ..params.clone() };
    let mut system = WallSystem::with_walls(placed, start, track.noise(), moves_by_velocity)?;
    system.front_end.laser_follows_log = params.laser_pose.is_none();
    if params.start_pose.is_none() {
        warn_of_start(system.events(), known, &track);
    }
    warn_of_ended_odometry(system.events(), overview, SCANS, SCANS_ALONE);
    let true_walls = truth::true_walls(overview);
    for (wall, id) in truth::nearest_to(&start, &true_walls, params.n_anchors).into_iter().zip(FIRST_ANCHOR..)
    {
        system.add_anchor(LandmarkId(id), truth::landmark(wall))?;
    }
    let between = |[start, end]: [[f64; 2]; 2]| {
        truth::landmark(&TrueWall { id: 0, start: start.into(), end: end.into() })
    };
    system.add_given_anchors(&params.anchors, None, between)?;
    if !track.is_empty() {
        // Else there is nothing to compare a batch with.
        system.estimator.follower = Some(Box::new(WallBatch::new(&system.estimator.filter)));
    }
    drive_through(system, track, true_walls, records, observe)
}

/// Goes on from a saved map with the records of a log that are later than it, and shows each step to `observe`. `association` is the rule
/// that was asked for, if any; `overview` and `records` are as in [`run_streamed`].
///
/// The start pose is that of the map. Keyframes, figures and events are those of this log alone.
///
/// # Errors
/// When the map is of another kind or is no state of the filter, when no later scan can be used, or a parameter is out of range.
pub fn run_on<R: Borrow<Record>>(
    saved: SavedWallMap,
    overview: &[Record],
    records: impl IntoIterator<Item = R>,
    params: &WallSlamParams,
    association: Option<AssociationRule>,
    observe: impl FnMut(RunStep<'_, WallSystem>),
) -> Result<WallRun> {
    let mut system = WallSystem::resume(params.clone(), saved, association)?;
    if let Some(by_velocity) = moves_by_velocity(overview) {
        system.front_end.moves_by_velocity = by_velocity;
    }
    warn_of_ended_odometry(system.events(), overview, SCANS, SCANS_ALONE);
    let track = ReferencePath::from_records_or_estimates(overview);
    drive_through(system, track, truth::true_walls(overview), records, observe)
}

/// Whether velocities move the robot, or increments do: a log may have the same motion twice, and increments win. `None` without both.
fn moves_by_velocity(overview: &[Record]) -> Option<bool> {
    let has = |is: fn(&RecordData) -> bool| overview.iter().any(|record| is(&record.data));
    let by_increments = has(|data| matches!(data, RecordData::OdometryIncrement(_)));
    (by_increments || has(|data| matches!(data, RecordData::Velocity(_)))).then_some(!by_increments)
}

/// What moves the robot without odometry.
const SCANS_ALONE: &str = "the motion comes from scan matching alone";

/// Says when no scan has an echo.
fn warn_of_blind_laser(events: &mut EventCounts, n_scans: u64) {
    if events.get("scan_without_echo") >= n_scans {
        let text = format!(
            "no beam of {n_scans} scans came back: all ranges are at or beyond range_max, zero or not finite (are they in metres?)"
        );
        events.warn("laser_is_blind", text);
    }
}

fn drive_through<R: Borrow<Record>>(
    system: WallSystem,
    truth: ReferencePath,
    true_map: Vec<TrueWall>,
    records: impl IntoIterator<Item = R>,
    observe: impl FnMut(RunStep<'_, WallSystem>),
) -> Result<WallRun> {
    let delay = system.front_end.params.odometry_delay;
    let mut run = SlamRun::new(system, &truth, true_map).through(records, observe);
    if run.system.stamped_estimates().is_empty() {
        let events = run.events();
        let n_before = events.get("record_before_resume");
        let why = events.refusals().first().map_or(String::new(), |first| format!(": {first}"));
        bail!("none of the scans could be used ({n_before} are before the end of the resumed run){why}");
    }
    run.system.front_end.turns.warn_of_lag(&mut run.system.estimator.events, delay);
    let n_scans = run.system.estimator.stamped_estimates.n_seen() as u64;
    warn_of_blind_laser(run.events(), n_scans);
    run.system.front_end.odometry_scale.warn(&mut run.system.estimator.events);
    let samples = run.samples();
    let is_odometry = |(stamped_estimate, sample): &(StampedEstimate, PoseWithTruth)| {
        sample.truth.local(&stamped_estimate.dead_reckoning).norm() < SAME
    };
    if !samples.is_empty() && samples.iter().all(is_odometry) {
        run.truth = ReferencePath::default();
        run.events().warn(
            "reference_is_odometry",
            "the poses of the log are its odometry: there are no figures of accuracy",
        );
    }
    warn_of_reference(run.system.events(), &run.truth);
    Ok(run)
}

/// The first pose of the laser in the log; the system follows a laser that moves.
fn laser_mount(records: &[Record]) -> Option<[f64; 3]> {
    records.iter().find_map(|record| match record.data {
        RecordData::LaserMount(mount) => Some([mount.x(), mount.y(), mount.heading()]),
        _ => None,
    })
}

/// Below this distance poses are the same but for printed digits, m and rad.
const SAME: f64 = 1e-3;

impl WallRun {
    /// The distance of each estimated wall from its true one, squared, in units of its covariance: see [`summarize`](super::summarize).
    pub(super) fn wall_nees(&self) -> Vec<f64> {
        self.system.filter().landmarks().filter_map(|wall| truth::nees(&wall, &self.true_map)).collect()
    }
}
