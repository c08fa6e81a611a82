use nalgebra::{DefaultAllocator, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, TangentMatrix};

use super::Association;
use crate::{EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, SlamAlloc};

/// Candidates that have to prove themselves before they enter the map.
///
/// They live outside the state, so a false detection costs the map nothing; the price is that the sightings before the last
/// confirmation do not inform it.
#[derive(Clone, Debug)]
pub(super) struct TentativeLandmarks<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    confirmations: usize,
    patience: usize,
    gate: f64,
    look: usize,
    next_id: u32,
    candidates: Vec<Candidate<M>>,
}

#[derive(Clone, Debug)]
struct Candidate<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    landmark: M::Landmark,
    covariance: TangentMatrix<M::Landmark>,
    n_seen: usize,
    last_seen: usize,
}

impl<M: LandmarkModel> TentativeLandmarks<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    pub(super) fn new(confirmations: usize, patience: usize, gate: f64) -> Self {
        Self { confirmations, patience, gate, look: 0, next_id: 0, candidates: Vec::new() }
    }

    /// Starts a look: forgets candidates that were not seen again in time.
    pub(super) fn begin_look(&mut self, filter: &EkfSlam<M>) {
        self.look += 1;
        self.candidates.retain(|candidate| self.look - candidate.last_seen <= self.patience);
        while filter.knows(LandmarkId(self.next_id)) {
            self.next_id += 1;
        }
    }

    /// Shows a sighting that is of no landmark: it confirms a candidate or becomes one.
    pub(super) fn offer(&mut self, filter: &EkfSlam<M>, measurement: &M::Measurement) -> Association {
        let new = filter.model().initialize(filter.robot(), measurement);
        let look = self.look;
        let same = |candidate: &Candidate<M>| {
            // Between two looks the robot hardly moves, so its own error is common to both and sensor noise alone tells them apart.
            let difference = candidate.landmark.local(&new.landmark);
            let cholesky = Cholesky::new(&candidate.covariance + &new.covariance);
            candidate.last_seen < look && cholesky.is_some_and(|s| difference.dot(&s.solve(&difference)) <= self.gate)
        };
        let n_seen = match self.candidates.iter().position(same) {
            Some(index) => self.candidates.swap_remove(index).n_seen + 1,
            None => 1,
        };
        if n_seen >= self.confirmations {
            let id = LandmarkId(self.next_id);
            self.next_id += 1;
            return Association::New(id);
        }
        self.candidates.push(Candidate { landmark: new.landmark, covariance: new.covariance, n_seen, last_seen: look });
        Association::Tentative
    }
}
