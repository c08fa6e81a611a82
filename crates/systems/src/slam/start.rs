use std::collections::BTreeSet;

use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::errors::ReferencePath;
use wayfix_sensor_log::Stamp;
use wayfix_slam_ekf::LandmarkId;

use crate::system::{EventCounts, TrueStartPose};

/// Says where the start pose comes from, unless it is the truth at the start.
pub(crate) fn warn_of_start(events: &mut EventCounts, known: Option<TrueStartPose>, truth: &ReferencePath) {
    match known {
        Some(TrueStartPose { seconds_late, .. }) if seconds_late > 0.0 => events.warn(
            "truth_begins_late",
            format!(
                "the truth begins {seconds_late:.2} s after the first observation: odometry leads the start pose back from there (`start_pose` sets it)"
            ),
        ),
        None if !truth.is_empty() => events.warn(
            "start_pose_unknown",
            "no true pose tells where the run starts: it starts at (0, 0, 0), and figures are aligned ones only (`start_pose` sets it)",
        ),
        _ => {}
    }
}

/// Says when a run has made no map.
pub(crate) fn warn_of_an_empty_map(events: &mut EventCounts, n_landmarks: usize) {
    if n_landmarks == 0 {
        events.warn(
            "map_is_empty",
            "no landmark was seen often enough to be in the map: the path is that of odometry and scan matching alone",
        );
    }
}

/// Says which given anchors were never seen: their identity or their place is unknown to the log.
pub(crate) fn warn_of_unseen_anchors(events: &mut EventCounts, unseen: &BTreeSet<LandmarkId>) {
    for id in unseen {
        let text = format!("anchor {id} was never seen: no observation of the log fits its place");
        events.warn("anchor_never_seen", text);
    }
}

/// Says when landmarks have left the state: what is left then is more certain than it should be.
pub(crate) fn warn_of_retired_landmarks(events: &mut EventCounts, n_retired: usize) {
    if n_retired > 0 {
        let text = format!(
            "{n_retired} landmarks have left the state (filter.retire_after): each error then counts as new in every observation, and the covariance of the pose is too small"
        );
        events.warn("landmarks_retired", text);
    }
}

/// Says when errors are differences from the poses of another program.
pub(crate) fn warn_of_reference(events: &mut EventCounts, truth: &ReferencePath) {
    if truth.is_estimate() {
        events.warn(
            "reference_is_another_estimate",
            "the log has no true poses: errors are differences from the poses of another program, whose own errors are unknown (--truth FILE gives true ones)",
        );
    }
}

/// Says when true poses have no time in common with the estimates.
pub(crate) fn warn_of_no_overlap(
    events: &mut EventCounts,
    truth: &ReferencePath,
    estimated: Option<(Stamp, Stamp)>,
) {
    let (Some((first, last)), Some((begin, end))) = (truth.span(), estimated) else { return };
    if end < first || last < begin {
        events.warn(
            "truth_does_not_overlap",
            format!("true poses ({first} to {last}) and estimates ({begin} to {end}) have no time in common: there are no figures of accuracy"),
        );
    }
}

/// The pose of parameters, else the known one, else the origin.
pub(crate) fn start_pose(given: Option<[f64; 3]>, known: Option<TrueStartPose>) -> Pose2<f64> {
    let given = given.map(|[x, y, heading]| Pose2::new(x, y, heading));
    given.or(known.map(|known| known.pose)).unwrap_or(Pose2::new(0.0, 0.0, 0.0))
}
