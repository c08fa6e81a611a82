use nalgebra::{DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, TangentMatrix};

use super::super::{EkfSlam, LandmarkEstimate};
use crate::{LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// A landmark that left the state and still corrects the rest.
#[derive(Clone, Debug)]
pub(in crate::filter) struct Retired<L: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<L::Dim, L::Dim>,
{
    pub(in crate::filter) mean: L,
    /// Its marginal covariance when it was retired.
    pub(in crate::filter) covariance: TangentMatrix<L>,
}

impl<L: Manifold<Scalar = f64>> Retired<L>
where
    DefaultAllocator: Allocator<L::Dim, L::Dim>,
{
    pub(in crate::filter) fn estimate(&self, id: LandmarkId) -> LandmarkEstimate<L> {
        LandmarkEstimate { id, mean: self.mean.clone(), covariance: self.covariance.clone() }
    }
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Removes a landmark from the state; its observations still correct robot and map. Returns `false` if it is not in the state.
    ///
    /// Its estimate is then fixed, and its observations have the noise $`R + H_m P_{mm} H_m^T`$ with its marginal $`P_{mm}`$ at that time;
    /// its correlations with robot and map are dropped. The paper does the same after more than 50 revisions and does not state
    /// the variance. [Andrade-Cetto 2005, end of Sec. 2.2, Fig. 7b]
    ///
    /// **This is cheaper, but less consistent.** The landmark's error is the same in every observation, but the filter treats it as independent noise and
    /// becomes overconfident of the robot's pose: NEES 6.1 in place of 3.0 for 50 revisions, 4.9 for 5, over 60 runs of two laps
    /// (`tests/integration/retirement.rs`). Over many laps it is worse. This, and not the anchor, makes the paper's combination of both inconsistent.
    /// To tie a map to the world, use an anchor with a known position.
    pub fn retire(&mut self, id: LandmarkId) -> bool {
        let Some(estimate) = self.landmark(id).filter(|_| self.landmarks.contains_key(&id)) else {
            return false;
        };
        self.remove(id);
        self.retired.insert(id, Retired { mean: estimate.mean, covariance: estimate.covariance });
        true
    }

    /// Number of retired landmarks; they count as landmarks of the map.
    pub fn n_retired(&self) -> usize {
        self.retired.len()
    }

    /// Makes the first confirmed landmarks anchors at their estimates, until the map has as many anchors as asked for.
    pub(in crate::filter) fn anchor_first(&mut self) {
        let n_missing = self.params.anchor_first.saturating_sub(self.anchors.len());
        let confirmed = self.landmarks.iter().filter(|(_, slot)| self.is_confirmed(slot));
        let first: Vec<LandmarkId> = confirmed.map(|(id, _)| *id).take(n_missing).collect();
        for id in first {
            self.fix(id);
        }
    }

    /// Makes a landmark an anchor at its estimate: the reference that defines the world from now on. Returns `false` if it is not in the state.
    ///
    /// Its error at that time moves the whole map, and the covariance does not include it. It is small against the errors of a long loop
    /// if the landmark was seen from near the start. [Andrade-Cetto 2005, Fig. 7b]
    pub fn fix(&mut self, id: LandmarkId) -> bool {
        let Some(mean) = self.landmarks.get(&id).map(|slot| self.mean(slot)) else { return false };
        self.remove(id);
        self.anchors.insert(id, mean);
        true
    }

    /// Retires the landmarks with more revisions than `retire_after`.
    pub(in crate::filter) fn retire_revised(&mut self) {
        let Some(most) = self.params.retire_after else { return };
        let is_done = |n_detections: usize| n_detections > most.saturating_add(1); // the first observation revises nothing
        let done: Vec<LandmarkId> = self
            .landmarks
            .iter()
            .filter(|(_, slot)| self.is_confirmed(slot) && is_done(slot.n_detections))
            .map(|(id, _)| *id)
            .collect();
        for id in done {
            self.retire(id);
        }
    }
}
