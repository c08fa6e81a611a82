use std::collections::BTreeSet;

use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::LandmarkId;
use wayfix_system_core::{EventCounts, TrueStartPose};

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

/// Mean NEES of three degrees of freedom that a consistent estimator reaches with a probability of 1 % at most, however its errors are correlated:
/// Markov's inequality.
const IMPLAUSIBLE_NEES: f64 = 3.0 / 0.01;

/// Says when the errors are far larger than their covariances allow.
pub(crate) fn warn_of_large_errors(events: &mut EventCounts, nees_mean: Option<f64>) {
    if let Some(nees) = nees_mean.filter(|nees| *nees > IMPLAUSIBLE_NEES) {
        let text = format!(
            "the mean NEES is {nees:.0}, and 3 for a consistent estimator: the truth or the resumed map is of another log, the noise is set too small, or the estimate went wrong"
        );
        events.warn("errors_exceed_covariances", text);
    }
}

/// The pose of parameters, else the known one, else the origin.
pub(crate) fn start_pose(given: Option<[f64; 3]>, known: Option<TrueStartPose>) -> Pose2<f64> {
    let given = given.map(|[x, y, heading]| Pose2::new(x, y, heading));
    given.or(known.map(|known| known.pose)).unwrap_or(Pose2::new(0.0, 0.0, 0.0))
}
