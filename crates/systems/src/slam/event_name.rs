use nalgebra::{DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::Manifold;
use wayfix_slam_ekf::ObservationOutcome;

/// What became of an observation, as the events of a run name it.
pub(crate) fn event_name<Z: Manifold<Scalar = f64>>(outcome: &ObservationOutcome<Z>) -> &'static str
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    match outcome {
        ObservationOutcome::Accepted { noise_scale, .. } if *noise_scale > 1.0 => "observation_downweighted",
        ObservationOutcome::Accepted { .. } => "observation_accepted",
        ObservationOutcome::Rejected { .. } => "observation_rejected_by_gate",
        ObservationOutcome::Initialized { .. } => "new_landmark",
        ObservationOutcome::Restarted { .. } => "tentative_landmark_restarted",
        ObservationOutcome::Ambiguous => "observation_neither_known_nor_new",
        ObservationOutcome::Unlabelled => "observation_without_identity",
        ObservationOutcome::Duplicate { .. } => "observation_duplicate",
        ObservationOutcome::Unusable => "observation_unusable",
        _ => "other",
    }
}
