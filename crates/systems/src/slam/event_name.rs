use nalgebra::{DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::Manifold;
use wayfix_slam_ekf::Outcome;

/// What became of an observation, as the events of a run name it.
pub(crate) fn event_name<Z: Manifold<Scalar = f64>>(outcome: &Outcome<Z>) -> &'static str
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    match outcome {
        Outcome::Accepted { noise_scale, .. } if *noise_scale > 1.0 => "accepted_downweighted",
        Outcome::Accepted { .. } => "accepted",
        Outcome::Rejected { .. } => "gated",
        Outcome::Initialized { .. } => "new_landmark",
        Outcome::Restarted { .. } => "restarted_landmark",
        Outcome::Ambiguous => "ambiguous",
        Outcome::Unlabelled => "unlabelled",
        Outcome::Duplicate { .. } => "duplicate",
        Outcome::Unusable => "unusable",
        _ => "other",
    }
}
