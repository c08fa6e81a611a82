use anyhow::{Result, bail};
use wayfix_estimation_traits::Manifold;
use wayfix_sensor_log::{Data, Record, TrueWall};
use wayfix_slam_ekf::LandmarkId;

use super::{WallSlamParams, WallState, WallSystem, truth};
use crate::system::KnownStart;
use crate::{
    slam::{
        AssociationRule, Saved, StampedEstimate, start_pose, warn_of_an_empty_map, warn_of_no_overlap,
        warn_of_reference, warn_of_start,
    },
    system::{
        DriveStep, Events, ODOMETRY, System, check_overlap, drive, warn_of_lag, without_odometry_delay,
    },
};
use wayfix_evaluation::errors::{Sample, TrueTrack};

/// A log of scans that went through EKF-SLAM with walls, beside the poses that the log itself holds.
pub struct WallRun {
    /// The system in its last state.
    pub system: WallSystem,
    /// True poses, or those that another program corrected, where the log has them.
    pub truth: TrueTrack,
    /// True walls, where the log has them.
    pub true_walls: Vec<TrueWall>,
}

/// Runs EKF-SLAM with walls over the records of a log and shows each step to `observe`.
///
/// The start pose is the true pose at the first scan, or led back to it by odometry from the first true pose after it, else the origin.
/// Nothing else ties the run to the truth.
///
/// # Errors
/// When there is no odometry, no scan, or a parameter is out of range.
pub fn run(
    records: &[Record],
    params: &WallSlamParams,
    observe: impl FnMut(DriveStep<'_, WallSystem>),
) -> Result<WallRun> {
    let first = |is: fn(&Data) -> bool| records.iter().find(|record| is(&record.data));
    let Some(scan) = first(|data| matches!(data, Data::Scan(_))) else {
        bail!("the log has no laser scans (`wayfix info` shows what a log holds)");
    };
    // A log may tell of the same motion twice.
    let moves_by_velocity = first(|data| matches!(data, Data::OdometryIncrement(_))).is_none();
    if moves_by_velocity && first(|data| matches!(data, Data::Velocity(_))).is_none() {
        bail!(
            "the log has neither odometry increments nor velocities, which EKF-SLAM with walls needs (`wayfix info` shows what it holds)"
        );
    }
    check_overlap(records, ODOMETRY, ("laser scans", |data| matches!(data, Data::Scan(_))))?;
    let track = TrueTrack::from_records_or_estimates(records);
    let known = KnownStart::at(scan.stamp, &track, records).filter(|_| params.start.is_none());
    let start = start_pose(params.start, known);
    let laser = params.laser.or_else(|| laser_mount(records));
    let placed = WallSlamParams { laser, ..params.clone() };
    let mut system = WallSystem::new(placed, start, track.noise(), moves_by_velocity)?;
    system.laser_follows_log = params.laser.is_none();
    if params.start.is_none() {
        warn_of_start(system.events(), known, &track);
    }
    let true_walls = truth::true_walls(records);
    for (wall, id) in truth::nearest_to(&start, &true_walls, params.n_anchors).into_iter().zip(FIRST_ANCHOR..)
    {
        system.add_anchor(LandmarkId(id), truth::landmark(wall))?;
    }
    drive_through(system, track, true_walls, records, observe)
}

/// Goes on from a saved map with the records of a log that are later than it, and shows each step to `observe`. `association` is the rule
/// that was asked for, if any.
///
/// The start pose is that of the map. Keyframes, figures and events are those of this log alone.
///
/// # Errors
/// When the map is of another kind or is no state of the filter, when no later scan can be used, or a parameter is out of range.
pub fn run_on(
    saved: Saved<WallState>,
    records: &[Record],
    params: &WallSlamParams,
    association: Option<AssociationRule>,
    observe: impl FnMut(DriveStep<'_, WallSystem>),
) -> Result<WallRun> {
    let system = WallSystem::resume(params.clone(), saved, association)?;
    let track = TrueTrack::from_records_or_estimates(records);
    drive_through(system, track, truth::true_walls(records), records, observe)
}

fn drive_through(
    mut system: WallSystem,
    track: TrueTrack,
    true_walls: Vec<TrueWall>,
    records: &[Record],
    observe: impl FnMut(DriveStep<'_, WallSystem>),
) -> Result<WallRun> {
    let records = without_odometry_delay(records, system.params.odometry_delay);
    drive(&mut system, records.iter(), observe);
    if system.stamped_estimates().is_empty() {
        let n_before = system.events().get("before_resume");
        bail!("none of the scans could be used; the events tell why (before_resume: {n_before})");
    }
    let stamped_estimates = system.stamped_estimates();
    let estimated = stamped_estimates
        .first()
        .zip(stamped_estimates.last())
        .map(|(first, last)| (first.stamp, last.stamp));
    let dead_reckoning: Vec<_> = stamped_estimates.iter().map(|at| (at.stamp, at.dead_reckoning)).collect();
    warn_of_no_overlap(system.events(), &track, estimated);
    let (seen_turns, delay) = (system.seen_turns().to_vec(), system.params.odometry_delay);
    warn_of_lag(system.events(), &dead_reckoning, &seen_turns, delay);
    let mut run = WallRun { system, truth: track, true_walls };
    let samples = run.samples();
    let is_odometry = |(stamped_estimate, sample): &(StampedEstimate, Sample)| {
        sample.truth.local(&stamped_estimate.dead_reckoning).norm() < SAME
    };
    if !samples.is_empty() && samples.iter().all(is_odometry) {
        run.truth = TrueTrack::default();
        run.events().warn(
            "reference_is_odometry",
            "the poses of the log are its odometry: there are no figures of accuracy",
        );
    }
    warn_of_reference(run.system.events(), &run.truth);
    let n_landmarks = run.system.filter().n_landmarks();
    warn_of_an_empty_map(run.system.events(), n_landmarks);
    Ok(run)
}

/// Where the log says that the laser is first; the system follows a laser that moves.
fn laser_mount(records: &[Record]) -> Option<[f64; 3]> {
    records.iter().find_map(|record| match record.data {
        Data::LaserMount(mount) => Some([mount.x(), mount.y(), mount.heading()]),
        _ => None,
    })
}

/// Identities of anchors, out of the way of those that association gives.
const FIRST_ANCHOR: u32 = 1 << 31;

/// Below this distance poses are the same but for printed digits, m and rad.
const SAME: f64 = 1e-3;

impl WallRun {
    /// Keyframes with the poses of the log.
    pub fn samples(&self) -> Vec<(StampedEstimate, Sample)> {
        let sample = |stamped_estimate: &StampedEstimate| {
            let StampedEstimate { stamp, pose, covariance, .. } = stamped_estimate;
            Some((*stamped_estimate, self.truth.sample(*stamp, *pose, covariance)?))
        };
        self.system.stamped_estimates().iter().filter_map(sample).collect()
    }
    /// How far each estimated wall is from its true one, in units of its covariance: see [`summarize`](super::summarize).
    pub(super) fn wall_nees(&self) -> Vec<f64> {
        self.system.filter().landmarks().filter_map(|wall| truth::nees(&wall, &self.true_walls)).collect()
    }
    /// What happened.
    pub fn events(&mut self) -> &mut Events {
        self.system.events()
    }
}
