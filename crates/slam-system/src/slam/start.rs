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

/// Share of gross errors in routine data: 1 to 10 %. [Hampel et al. 1986, section 1.2c]
const LARGEST_GROSS_SHARE: f64 = 0.1;

/// Says when more observations lie outside their gates than those of a consistent filter, which pass with `gate_probability`, and outliers of a sensor explain.
pub(crate) fn warn_of_gross_errors(events: &mut EventCounts, gate_probability: f64) {
    let outside =
        ["observation_downweighted", "observation_rejected_by_gate", "tentative_landmark_restarted"];
    let n_outside: u64 = outside.iter().map(|name| events.get(name)).sum();
    let n_all = n_outside + events.get("observation_accepted");
    let n = n_all.max(1) as f64;
    let (share, expected) = (n_outside as f64 / n, LARGEST_GROSS_SHARE + (1.0 - gate_probability));
    // Three standard deviations of a binomial share.
    if share > expected + 3.0 * (expected * (1.0 - expected) / n).max(0.0).sqrt() {
        let percent = 100.0 * share;
        let text = format!(
            "{n_outside} of {n_all} observations ({percent:.0} %) contradict odometry and map: check units and signs of both, identities, stamps, and the noise of the parameters"
        );
        events.warn("observations_contradict_odometry", text);
    }
}

/// The pose of parameters, else the known one, else the origin.
pub(crate) fn start_pose(given: Option<[f64; 3]>, known: Option<TrueStartPose>) -> Pose2<f64> {
    let given = given.map(|[x, y, heading]| Pose2::new(x, y, heading));
    given.or(known.map(|known| known.pose)).unwrap_or(Pose2::new(0.0, 0.0, 0.0))
}
