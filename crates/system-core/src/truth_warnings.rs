use wayfix_evaluation::errors::{PoseWithTruth, ReferencePath, trajectory_errors};
use wayfix_sensor_log::Stamp;

use crate::{EventCounts, TrueStartPose};

/// Says where the start pose comes from, unless it is the truth at the start.
pub fn warn_of_start(events: &mut EventCounts, known: Option<TrueStartPose>, truth: &ReferencePath) {
    match known {
        Some(TrueStartPose { seconds_late, .. }) if seconds_late > 0.0 => events.warn(
            "truth_begins_late",
            format!(
                "the truth begins {seconds_late:.2} s after the first observation: odometry leads the start pose back from there (`start_pose` sets it)"
            ),
        ),
        None if !truth.is_empty() => events.warn(
            "start_pose_unknown",
            "no true pose at the start: the run starts at (0, 0, 0), and figures are aligned ones only (`start_pose` sets it)",
        ),
        _ => {}
    }
}

/// Says when errors are differences from the poses of another program.
pub fn warn_of_reference(events: &mut EventCounts, truth: &ReferencePath) {
    if truth.is_estimate() {
        events.warn(
            "reference_is_another_estimate",
            "the log has no true poses: errors are differences from the poses of another program, whose own errors are unknown (--truth FILE gives true ones)",
        );
    }
}

/// Mean NEES of three degrees of freedom that a consistent estimator reaches with a probability of 1 % at most, however its errors are correlated:
/// Markov's inequality.
const IMPLAUSIBLE_NEES: f64 = 3.0 / 0.01;

/// Says when the errors are far larger than their covariances allow.
pub fn warn_of_large_errors(events: &mut EventCounts, truth: &ReferencePath, samples: &[PoseWithTruth]) {
    let nees = trajectory_errors(samples).and_then(|errors| errors.nees_mean);
    if let Some(nees) = nees.filter(|nees| !truth.is_estimate() && *nees > IMPLAUSIBLE_NEES) {
        let text = format!(
            "the mean NEES is {nees:.0}, and 3 for a consistent estimator: the truth or the resumed map is of another log, the noise is set too small, or the estimate went wrong"
        );
        events.warn("errors_exceed_covariances", text);
    }
}

/// Says when true poses have no time in common with the estimates.
pub fn warn_of_no_overlap(
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
