use std::collections::BTreeSet;

use nalgebra::{DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::Manifold;
use wayfix_slam_ekf::{LandmarkId, ObservationOutcome, UpdateReport};
use wayfix_system_core::EventCounts;

/// Finds runs that continue with the map of another place: a robot is where its map was saved, so that it knows most of what it sees first.
#[derive(Clone, Debug)]
pub(super) struct SavedMapCheck {
    saved: BTreeSet<LandmarkId>,
    n_known: usize,
    n_seen: usize,
}

/// Number of first observations of saved and of new landmarks. If they were independent, the share of the saved ones would be certain to 0.07.
const N_FIRST: usize = 50;

impl SavedMapCheck {
    pub(super) fn new(saved: BTreeSet<LandmarkId>) -> Self {
        Self { saved, n_known: 0, n_seen: 0 }
    }

    /// Takes a scan. After the first ones, says if less than half of them fit the map. A new landmark counts once; what is neither known nor new does not.
    pub(super) fn add<Z: Manifold<Scalar = f64>>(
        &mut self,
        report: &UpdateReport<Z>,
        events: &mut EventCounts,
    ) where
        DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
    {
        if self.n_seen >= N_FIRST {
            return;
        }
        for outcome in &report.outcomes {
            use ObservationOutcome::{Accepted, Initialized, Rejected, Restarted};
            let (is_seen, is_known) = match outcome {
                Accepted { landmark, noise_scale, .. } => {
                    let is_saved = self.saved.contains(landmark);
                    (is_saved, is_saved && *noise_scale <= 1.0)
                }
                Initialized { .. } | Rejected { .. } | Restarted { .. } => (true, false),
                _ => (false, false),
            };
            self.n_seen += usize::from(is_seen);
            self.n_known += usize::from(is_known);
        }
        if self.n_seen >= N_FIRST && 2 * self.n_known < self.n_seen {
            let text = format!(
                "{} of the first {} observations fit the saved map: is it the map of this place, and is the robot where it was when the map was saved?",
                self.n_known, self.n_seen
            );
            events.warn("saved_map_not_recognized", text);
        }
    }
}
